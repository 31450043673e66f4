"""The command line: options and help, and one file for each mode."""
