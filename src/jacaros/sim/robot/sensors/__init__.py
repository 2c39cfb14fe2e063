"""The sensors of a robot, with their topics."""
