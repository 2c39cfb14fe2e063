"""A driver for a middleware that is not ROS: MQTT.  docs/how-to/add_a_middleware.md explains it."""
