"""Reading and writing world files and maps: YAML and images to and from plain descriptions."""
