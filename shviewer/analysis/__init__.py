"""The analysis of a light: projections, figures and comparisons, each computed once."""
