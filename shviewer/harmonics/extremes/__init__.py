"""Extremes with a certificate: values that a function takes, and bounds that it passes nowhere."""
