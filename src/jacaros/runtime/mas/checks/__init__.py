"""Checks of programs and projects without running them."""
