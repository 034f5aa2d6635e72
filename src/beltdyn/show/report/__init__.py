"""Reports: results as one self-contained page."""

from beltdyn.show.report.build import report_file, require_report, write_report
from beltdyn.show.report.interactive import InteractiveFigures, interactive

__all__ = ["InteractiveFigures", "interactive", "report_file", "require_report", "write_report"]
