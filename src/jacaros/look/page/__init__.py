"""What shows a run: the live page, replay pages, the view in a terminal, and pictures."""
