"""How a frame is divided: rows of panes, and the area of the numbers."""
