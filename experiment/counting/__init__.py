"""Counts programs of agents, each beside a baseline: a Python program without agents that does the same.

Both are counted by the rules in docs/reference/metrics.md.
"""

from counting.baselines import Group, measure, measure_chart

__all__ = ["Group", "measure", "measure_chart"]
