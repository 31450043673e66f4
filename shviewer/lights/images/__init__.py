"""Image files: a decoder for each format, from bytes to linear radiance."""
