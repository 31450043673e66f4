"""What is measured: the lights, the ways to project and to evaluate them, and the clock. Each section has a file."""
