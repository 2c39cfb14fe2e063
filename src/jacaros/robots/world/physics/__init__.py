"""The running world: robots, people, doors, dirt and faults. It knows neither ROS nor a clock."""
