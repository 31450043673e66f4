"""Pictures as files: how they are written, the stamp that tells how they were made, and how they are compared."""
