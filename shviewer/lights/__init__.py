"""Lights: sums of lobes, environment maps, Python functions and coefficients."""
