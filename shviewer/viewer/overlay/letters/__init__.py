"""Letters: how text and numbers are set and drawn."""
