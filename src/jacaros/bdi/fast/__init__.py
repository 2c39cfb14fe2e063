"""What makes the mind fast: each file stands for a rule and may be left out."""
