"""Suns: compact sources found in a light and taken out of it as discs."""
