"""Lists of coefficients as other programs, shaders, spreadsheets and people write them."""
