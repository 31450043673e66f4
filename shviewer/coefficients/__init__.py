"""Lists of numbers and what they mean: conventions of programs, and coefficient files, read and written."""
