"""Fault injection in the embedded world: fault files, their schedule and their effects."""
