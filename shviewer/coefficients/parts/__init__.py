"""The parts of a convention: its axes, its normalisation, the order of its rows, and what its numbers are of."""
