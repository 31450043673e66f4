"""Coefficient files: what they say of themselves, how they are read, and the light that they are."""
