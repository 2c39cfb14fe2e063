"""The part of ``nav2_msgs`` that the baselines use: look-alikes, as the wheels of ROS 2 do not include the package."""
