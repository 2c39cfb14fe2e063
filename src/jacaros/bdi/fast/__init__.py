"""Plans and rules as Python code, generated from their syntax; `jacaros.bdi.rules` does without it."""
