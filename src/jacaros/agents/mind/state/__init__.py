"""The state of a mind: data, and what keeps it in order."""
