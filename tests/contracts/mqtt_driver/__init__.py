"""A driver for a middleware that is not ROS: MQTT.  docs/reference/middleware.md explains it."""
