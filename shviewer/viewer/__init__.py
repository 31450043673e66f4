"""The viewer: state and keys, pictures as plain arrays, and a thin shell of OpenGL and GLFW."""
