"""Reading and writing world files and maps."""
