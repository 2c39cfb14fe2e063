"""What happened in a run: observers of a running system, the records they make, and answers to questions about them."""
