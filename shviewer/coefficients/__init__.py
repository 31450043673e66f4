"""Lists of coefficients and their meaning: the conventions of programs, and coefficient files, read and written."""
