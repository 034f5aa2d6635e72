"""Reports: results as one self-contained page."""

from beltdyn.report.build import report_file, require_report, write_report
from beltdyn.report.interactive import InteractiveFigures, interactive

__all__ = ["InteractiveFigures", "interactive", "report_file", "require_report", "write_report"]
