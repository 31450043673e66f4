"""From the bytes of an image file to linear radiance: one decoder per format, and what they share."""
