"""The history of a run: observers, records, and answers to questions."""
