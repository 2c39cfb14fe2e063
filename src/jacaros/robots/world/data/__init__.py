"""A world as plain data: what world files and fault files describe, and what truly happens in a run."""
