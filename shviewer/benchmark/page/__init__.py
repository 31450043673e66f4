"""How the page is drawn: tables, advice and plots, all made from the rows of a report and from nothing else."""
