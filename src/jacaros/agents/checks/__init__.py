"""Checks of programs without syntax errors, one kind of mistake per function."""
