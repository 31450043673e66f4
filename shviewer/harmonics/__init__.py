"""Real spherical harmonics in float64: pure functions of numpy arrays that know no light, no file and no OpenGL."""
