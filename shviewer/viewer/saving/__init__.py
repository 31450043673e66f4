"""Pictures as files: how they are written, what they say of themselves, and how they are compared."""
