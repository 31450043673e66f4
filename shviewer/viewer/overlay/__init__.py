"""The overlay that Pillow draws over the spheres: text, figures, plots, marks."""
