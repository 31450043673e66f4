"""See a light beside its spherical-harmonic reconstruction, with error figures that can be trusted."""

__version__ = "0.1.0"
