"""Coefficients out: projecting lights into files that state their convention, and the functions of `import shviewer`."""
