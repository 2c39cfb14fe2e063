"""Servers for editors, and what they know about the programs of a project."""
