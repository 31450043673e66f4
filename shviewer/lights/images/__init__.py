"""Image files: one decoder a format, from bytes to linear radiance."""
