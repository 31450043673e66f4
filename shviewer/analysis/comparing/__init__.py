"""Given coefficients beside those of a light: whether they agree, and by which mistake or convention they are off."""
