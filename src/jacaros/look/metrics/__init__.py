"""The size of programs: identifiers, lines and compressed bytes, by the rules in docs/reference/metrics.md.

`measure` counts whole programs; `measure_table` and `measure_chart` show the counts.
"""

from jacaros.look.metrics.charts import Series, bar_chart, measure_chart
from jacaros.look.metrics.counting import MEASURES, CountedFile, Counts, Group, ProgramMetrics, counts_of
from jacaros.look.metrics.programs import MetricsError, measure
from jacaros.look.metrics.tables import (
    Table,
    as_markdown,
    as_text,
    file_table,
    measure_table,
)

__all__ = [
    "MEASURES",
    "CountedFile",
    "Counts",
    "Group",
    "MetricsError",
    "ProgramMetrics",
    "Series",
    "Table",
    "as_markdown",
    "as_text",
    "bar_chart",
    "counts_of",
    "file_table",
    "measure",
    "measure_chart",
    "measure_table",
]
