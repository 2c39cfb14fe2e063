"""Records of a run: their schema, and recordings."""
