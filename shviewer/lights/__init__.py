"""What is projected: sums of lobes, environment maps and Python functions."""
