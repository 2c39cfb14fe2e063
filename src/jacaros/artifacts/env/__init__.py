"""The environment: workspaces, artifacts, and what they share."""
