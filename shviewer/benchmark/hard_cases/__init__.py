"""Hard cases of spherical-harmonic arithmetic, each with its right answer and the error of this program.

Most files declare the cases of one subject; exact makes references to 60 digits; shader draws the cases that concern the
fragment shader; table runs all of them and shows the results.
"""
