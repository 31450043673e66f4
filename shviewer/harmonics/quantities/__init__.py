"""Quantities of a light: radiance, irradiance and glossy reflection, their kernels, and how engines store irradiance."""
