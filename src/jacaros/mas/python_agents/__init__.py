"""Agents written in Python, in a run."""
