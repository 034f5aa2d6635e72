"""Results as one page: a file to mail, to open in any browser, and to print."""

from beltdyn.report.build import report_file, require_report, write_report
from beltdyn.report.interactive import InteractiveFigures, interactive

__all__ = ["InteractiveFigures", "interactive", "report_file", "require_report", "write_report"]
