"""Images in containers that are less usual for light: PFM, DDS, NumPy's arrays, and those that OpenImageIO reads."""
