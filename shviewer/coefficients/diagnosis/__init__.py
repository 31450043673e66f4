"""What is wrong with somebody else's coefficients of a light that is known: the convention in which they would be right."""
