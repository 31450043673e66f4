"""The window: events in, frames out."""
