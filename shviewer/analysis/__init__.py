"""What is known of a light: projections, figures, comparisons, each computed once."""
