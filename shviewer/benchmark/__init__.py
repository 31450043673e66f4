"""Speed against error on the machine at hand: `shviewer report`.

run.py goes through the sections. What is measured is in measuring/, how rows are kept in rows/, how the page is drawn from them
in page/, and hard_cases/ has the table of `--stability`.
"""
