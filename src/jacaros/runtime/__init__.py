"""What a run is made of: its clock, its output, and the causes of what happens."""
