"""The artifacts that every workspace has from the beginning."""
