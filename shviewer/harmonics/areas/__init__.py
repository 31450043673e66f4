"""Exact integrals of the basis over areas of the sphere, such as texels, without a rule for each of them."""
