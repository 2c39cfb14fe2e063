"""Artifacts that help agents to work together, known from CArtAgO's package ``cartago.tools``."""
