"""Faults of a simulated world: what goes wrong in it, when, and what that does."""
