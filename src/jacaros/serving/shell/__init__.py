"""Consoles and commands that talk to the agents of a running system over HTTP."""
