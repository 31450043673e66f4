"""Sheets with curves in place of the spheres."""
