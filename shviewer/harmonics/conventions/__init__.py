"""Other programs' conventions for spherical-harmonic coefficients, and the conversions between them and ours."""
