"""The report as it is written: tables, plots, the page, and what has changed since an older one."""
