"""Python agents in a run."""
