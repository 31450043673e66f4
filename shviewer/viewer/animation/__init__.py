"""Sweeps and turntables: frames over time, and the files they go into."""
