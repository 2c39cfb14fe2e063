"""Agents: the language, the minds that run it, their bodies, and agents in Python."""
