"""Navigation of a simulated robot: plan paths, follow them, dock, and offer this as actions."""
