"""Everything that knows OpenGL: programs, textures, and the renderer of a Picture."""
