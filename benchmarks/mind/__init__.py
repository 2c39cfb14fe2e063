"""Measuring the mind: programs, and the engines that run them."""
