"""What goes on behind the window: pictures that are made, lights that are opened, files that are written."""
