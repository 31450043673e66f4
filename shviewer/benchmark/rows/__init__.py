"""How rows are kept: one row, the report of all of them as JSON, and the changes between two reports."""
