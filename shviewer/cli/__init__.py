"""The command line: flags and help, one file a mode."""
