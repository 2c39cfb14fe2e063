"""Counts the source code of programs of agents: identifiers, lines and compressed bytes, also of baselines without agents.

docs/reference/metrics.md has the rules. ``python experiment/counting FOLDER...`` prints the counts.
"""

from counting.baselines import measure_beside
from counting.counts import MEASURES, CountedFile, Counts, Group, ProgramMetrics, counts_of
from counting.programs import MetricsError, measure
from counting.tables import Table, as_markdown

__all__ = [
    "MEASURES",
    "CountedFile",
    "Counts",
    "Group",
    "MetricsError",
    "ProgramMetrics",
    "Table",
    "as_markdown",
    "counts_of",
    "measure",
    "measure_beside",
]
