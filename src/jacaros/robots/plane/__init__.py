"""Planar geometry: poses, headings, shapes and paths, in metres and radians. It knows neither messages nor the world."""
