"""Program robots as rational agents: AgentSpeak minds, artifacts and ROS, in Python."""

__version__ = "0.1.0"
