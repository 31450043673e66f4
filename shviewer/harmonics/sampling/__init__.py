"""Sampling functions of directions of which nothing is known beforehand."""
