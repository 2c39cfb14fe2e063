"""Resources that operations and plans share, such as the wheels of a robot: who holds them, and who waits."""
