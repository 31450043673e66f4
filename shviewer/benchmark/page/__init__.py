"""The report as files: tables, plots, the page, and the changes since an older report."""
