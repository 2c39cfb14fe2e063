"""Bar charts as SVG, in the style of figures 8.7 to 8.9 of the thesis.

They suit light and dark pages, need no other files, and are identical for identical numbers.
"""

import html
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

from counting.counts import MEASURES, Group, ProgramMetrics

_STYLE: Final = """
  text{fill:#23282e;font:12px system-ui,sans-serif} .title{font-weight:600;font-size:14px}
  .tick{fill:#77746a;font-size:11px} .grid{stroke:#dedbd2} .axis{stroke:#77746a}
  .c0{fill:#1f6f8b} .c1{fill:#8fc1d1} .c2{fill:#b4572e} .c3{fill:#e0a98c} .c4{fill:#6b5aa8} .c5{fill:#b9aede}
  @media (prefers-color-scheme: dark) {
    text{fill:#e7e9ec} .tick{fill:#8b95a0} .grid{stroke:#313840} .axis{stroke:#8b95a0}
  }
"""
_COLOURS: Final = 6
_LEFT, _RIGHT, _TOP, _BOTTOM = 56, 12, 64, 28
"""Margins in pixels; the upper one holds the title and the legend."""
_HEIGHT: Final = 240
"""Size of the plot in pixels."""
_CATEGORY: Final = 128
"""Width of a category in pixels, enough for the name of a program."""
_NARROWEST: Final = 480
_GAP: Final = 0.3
"""Empty fraction of a category."""
_TICKS: Final = 5


@dataclass(frozen=True)
class Series:
    """A series of a chart: its name in the legend, and a value for each category."""

    name: str
    values: tuple[int, ...]


def measure_chart(programs: Sequence[ProgramMetrics], measure: str) -> str:
    """Return the chart of one measure as SVG: artifacts on top of agents, next to the baseline if there is one.

    Args:
        programs: the categories.
        measure: one of `MEASURES`.
    """
    groups: list[tuple[Group, ...]] = [(Group.AGENTS, Group.ARTIFACTS)]
    if any(Group.BASELINE in each.files for each in programs):
        groups.append((Group.BASELINE,))
    stacks = [
        [Series(group, tuple(getattr(each.counts(group), measure) for each in programs)) for group in stack]
        for stack in groups
    ]
    return bar_chart(MEASURES[measure], [each.name for each in programs], stacks)


def bar_chart(title: str, categories: Sequence[str], stacks: Sequence[Sequence[Series]]) -> str:
    """Return a bar chart as SVG.

    Args:
        title: title above the chart.
        categories: names below the bars.
        stacks: bars next to each other in each category; the series of a stack are stacked, the first one at the bottom.
            Series of zeros are left out of the legend.
    """
    width = max(_NARROWEST, _LEFT + _RIGHT + _CATEGORY * len(categories))
    height = _TOP + _HEIGHT + _BOTTOM
    sums = [sum(values) for stack in stacks for values in zip(*(each.values for each in stack), strict=True)]
    step = _step(max(sums, default=0))
    parts = [
        f'<text class="title" x="{_LEFT}" y="20">{html.escape(title)}</text>',
        *_legend(stacks),
        *_axis(step, width),
        *_bars(step, width, categories, stacks),
    ]
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" '
        f'height="{height}" role="img" aria-label="{html.escape(title)}">\n'
        f"<style>{_STYLE}</style>\n" + "\n".join(parts) + "\n</svg>\n"
    )


def _step(highest: int) -> int:
    """Return a round step, of which a few reach the highest value."""
    least = max(1, math.ceil(highest / _TICKS))
    power = int(10 ** math.floor(math.log10(least)))
    return next(power * factor for factor in (1, 2, 3, 4, 5, 6, 8, 10) if power * factor >= least)


def _y(value: float, step: int) -> float:
    return round(_TOP + _HEIGHT * (1 - value / (step * _TICKS)), 1)


def _colour(stack: int, level: int) -> str:
    """Return the class of a colour; each stack has two similar ones."""
    return f"c{(2 * stack + level) % _COLOURS}"


def _legend(stacks: Sequence[Sequence[Series]]) -> Iterator[str]:
    x = _LEFT
    for place, stack in enumerate(stacks):
        for level, each in enumerate(stack):
            if any(each.values):
                yield f'<rect class="{_colour(place, level)}" x="{x}" y="34" width="12" height="12"/>'
                yield f'<text x="{x + 17}" y="44">{html.escape(each.name)}</text>'
                x += 40 + 7 * len(each.name)


def _axis(step: int, width: int) -> Iterator[str]:
    for value in range(0, (_TICKS + 1) * step, step):
        y = _y(value, step)
        yield f'<path class="{"grid" if value else "axis"}" d="M{_LEFT} {y}H{width - _RIGHT}"/>'
        yield f'<text class="tick" text-anchor="end" x="{_LEFT - 6}" y="{y + 4:.1f}">{value}</text>'


def _bars(
    step: int, width: int, categories: Sequence[str], stacks: Sequence[Sequence[Series]]
) -> Iterator[str]:
    """Yield the bars with their sums, and then the names of the categories."""
    category_width = (width - _LEFT - _RIGHT) / max(1, len(categories))
    bar_width = category_width * (1 - _GAP) / max(1, len(stacks))
    names = []
    for number, category in enumerate(categories):
        middle = round(_LEFT + category_width * (number + 0.5), 1)
        for place, stack in enumerate(stacks):
            left = middle + bar_width * (place - len(stacks) / 2)
            below = 0
            for level, each in enumerate(stack):
                value = each.values[number]
                top, bottom = _y(below + value, step), _y(below, step)
                below += value
                if value:
                    about = html.escape(f"{category}, {each.name}: {value}")
                    size = f'x="{left + 1:.1f}" y="{top}" width="{bar_width - 2:.1f}" height="{bottom - top:.1f}"'
                    yield f'<rect class="{_colour(place, level)}" {size}><title>{about}</title></rect>'
            x = round(left + bar_width / 2, 1)
            yield f'<text text-anchor="middle" x="{x}" y="{_y(below, step) - 4:.1f}">{below}</text>'
        shown = html.escape(category.replace("_", " "))
        names.append(f'<text text-anchor="middle" x="{middle}" y="{_TOP + _HEIGHT + 18}">{shown}</text>')
    yield from names
