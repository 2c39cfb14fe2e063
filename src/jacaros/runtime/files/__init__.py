"""Files of users: texts with places, YAML, Python modules, maps."""
