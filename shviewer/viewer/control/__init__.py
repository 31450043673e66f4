"""Control: the keys, and what they make of a state."""
