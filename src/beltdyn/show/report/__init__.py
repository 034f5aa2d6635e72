"""Reports: results as one self-contained page."""

from beltdyn.show.report.report import InteractiveFigures, interactive, report_file, require_report, write_report

__all__ = ["InteractiveFigures", "interactive", "report_file", "require_report", "write_report"]
