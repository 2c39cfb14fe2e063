"""Navigation of a simulated robot: planning, path following and docking, served as actions."""
