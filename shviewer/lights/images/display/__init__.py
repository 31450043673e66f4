"""PNG and JPEG: pictures made for a display, whose codes are turned back into light that is proportional to radiance."""
