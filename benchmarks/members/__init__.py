"""Processes that are measured: systems of a fleet, and others to compare them with."""
