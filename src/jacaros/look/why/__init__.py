"""Why something happened: explanations found in the records of a run."""
