"""From radiance and errors to the colours of a picture."""
