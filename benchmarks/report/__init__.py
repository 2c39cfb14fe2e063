"""What the figures look like to people: tables, goals, pictures, the page in the documentation."""
