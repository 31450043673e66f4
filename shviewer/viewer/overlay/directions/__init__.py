"""What is said of single directions: marks of the peak, the minimum and the largest error, and the probe under the mouse."""
