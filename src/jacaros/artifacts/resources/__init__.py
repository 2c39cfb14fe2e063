"""Resources that operations and plans share, such as the wheels of a robot."""
