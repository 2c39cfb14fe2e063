"""Inspection of a live graph for ``jacaros ros``."""
