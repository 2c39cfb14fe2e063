"""What a robot of the world does by itself: plan a way, drive it, dock, and offer that as actions."""
