"""The agents of a run, their programs and their Python code."""
