"""A multi-agent system inside a Python program."""
