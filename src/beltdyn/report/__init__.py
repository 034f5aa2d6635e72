"""Results as one page: a file to mail, to open in any browser, and to print."""

from beltdyn.report.build import report_file, require_report, write_report

__all__ = ["report_file", "require_report", "write_report"]
