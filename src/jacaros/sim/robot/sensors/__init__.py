"""The sensors of a robot: what each one measures, and the topic on which it publishes."""
