"""Analytic lights: sums of lobes, their convolutions, and the scene files that name them."""
