"""The window: events in, frames out; behind/, what goes on meanwhile."""
