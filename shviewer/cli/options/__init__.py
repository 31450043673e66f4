"""Options of the command line: those of each mode, how their values are read, and what is made of them."""
