"""How an image covers the sphere: one file per layout, and the rule by which a file's layout is recognised."""
