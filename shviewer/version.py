"""The version, for whoever stamps it on what is written. It imports nothing."""

__version__ = "1.0.0"
