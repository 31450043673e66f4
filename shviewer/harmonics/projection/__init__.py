"""From values to coefficients: of rows and images, and of samples that lie anywhere."""
