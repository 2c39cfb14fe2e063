"""Planar geometry: poses, headings and paths, in metres and radians. It knows neither messages' types nor the world."""
