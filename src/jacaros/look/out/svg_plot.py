"""Plots of numbers over time as SVG, for papers: panels with a common time axis, thresholds and failures.

The picture is identical for identical recordings, and needs no other files.
"""

import html
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any, NamedTuple

from jacaros.look.out.limits import limits
from jacaros.look.out.series import Series, named
from jacaros.look.records.recording import Recording
from jacaros.look.records.words import cut
from jacaros.runtime.files.texts import printable

_STYLE = """
  text{font:12px system-ui,sans-serif;fill:#222} .grid{stroke:#e3e3e3} .axis{stroke:#222;fill:none}
  .curve{fill:none;stroke-width:1.5;stroke-linejoin:round} .limit{fill:none;stroke:#555;stroke-dasharray:6 3}
  .note{font-size:11px;fill:#555;stroke:#fff;stroke-width:3px;paint-order:stroke}
  .failed{stroke:#c00;fill:#c00} .handled{stroke:#c00;fill:#fff}
  .faint{stroke-opacity:.3}
"""
_COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000")
"""Colours of Okabe and Ito, which readers with any colour vision can tell apart."""
_DASHES = ("", "7 3", "2 2", "9 3 2 3")
_WIDTH, _LEFT, _RIGHT = 720, 64, 16
_HEIGHT, _HEAD, _FOOT = 140, 30, 46
_GLYPH = 6.6
"""Width of a character, about."""
_MOST_SIGNS = 40
"""Maximum length of a goal in the legend."""


class Failure(NamedTuple):
    """A goal that failed; *is_handled* if a plan for its failure succeeded."""

    t: float
    goal: str
    is_handled: bool


@dataclass(frozen=True)
class Panel:
    """Curves with a common axis.

    Attributes:
        curves: labels and series.
        limits: labels and series of values with which programs compare a curve.
    """

    curves: Sequence[tuple[str, Series]]
    limits: Sequence[tuple[str, Series]] = ()

    @property
    def units(self) -> str:
        """The units of the axis."""
        return ", ".join(dict.fromkeys(series.unit for _, series in self.curves if series.unit))

    def between(self, start: float, end: float) -> "Panel":
        """Return the panel from *start* to *end*, without limits that are far from the curves."""
        curves = [(label, each.between(start, end)) for label, each in self.curves]
        limits = [(label, each.between(start, end)) for label, each in self.limits]
        low, high = _range(curves)
        around = (high - low) / 2
        near = [each for each in limits if low - around <= _range([each])[0] <= high + around]
        return Panel(curves, near)


def panel_of(recording: Recording, known: Sequence[Series], names: Iterable[str]) -> Panel:
    """Return the panel of the series with these names, and what programs compare them with."""
    curves = []
    for name in names:
        found = named(known, name)
        curves += [(name if len(found) == 1 else f"{each.owner}:{name}", each) for each in found]
    compared = dict(limit for _, each in curves for limit in limits(recording, each, known))
    return Panel(curves, [*compared.items()])


def failures(events: Iterable[tuple[float, str, Mapping[str, Any]]]) -> list[Failure]:
    """Return the failures of goals, the oldest first."""
    found: dict[tuple[str, Any], Failure] = {}
    for t, kind, data in events:
        if kind == "goal" and data["state"] in ("failed", "recovered"):
            found[data["agent"], data.get("id")] = Failure(t, str(data["goal"]), data["state"] == "recovered")
    return sorted(found.values())


def plot_svg(
    panels: Sequence[Panel], failed: Sequence[Failure], time: tuple[float, float], title: str
) -> str:
    """Return the SVG text of a plot from the first to the second *time*, in seconds."""
    sheet = _Sheet(*time)
    failed = [each for each in failed if sheet.start <= each.t <= sheet.end]
    panels = [panel.between(*time) for panel in panels]
    parts: list[str] = []
    bottom = 0
    for panel in panels:
        legend = list(_legend(panel, bottom + _HEAD))
        bottom = legend[-1].y + 7 + _HEIGHT
        parts += _panel(sheet, panel, legend, bottom)
    height = bottom + _FOOT
    title = _escaped(title)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_WIDTH} {height}" width="{_WIDTH}" height="{height}" '
        f'role="img" aria-label="{title}">\n<title>{title}</title>\n<style>{_STYLE}</style>\n'
        f'<rect width="{_WIDTH}" height="{height}" fill="#fff"/>\n'
        + "\n".join([*parts, *_time_axis(sheet, bottom), *_failures(sheet, failed, bottom)])
        + "\n</svg>\n"
    )


class _Sheet(NamedTuple):
    """Converts seconds to pixels."""

    start: float
    end: float

    def x(self, t: float) -> float:
        share = (t - self.start) / ((self.end - self.start) or 1.0)
        return round(_LEFT + share * (_WIDTH - _LEFT - _RIGHT), 1)


class _Scale:
    """Converts the values of a panel to pixels; the numbers of its axis are *ticks*."""

    def __init__(self, panel: Panel, bottom: int) -> None:
        lowest, highest = _range([*panel.curves, *panel.limits])
        step = _nice((highest - lowest) / 4 or 1.0)
        low, high = math.floor(lowest / step), math.ceil(highest / step)
        self.ticks = [number * step for number in range(low, max(high, low + 1) + 1)]
        self._bottom = bottom

    def y(self, value: float) -> float:
        low, high = self.ticks[0], self.ticks[-1]
        return round(self._bottom - (value - low) / (high - low) * _HEIGHT, 1)


def _range(curves: Iterable[tuple[str, Series]]) -> tuple[float, float]:
    """Return the least and greatest value of curves."""
    values = [value for _, series in curves for _, value in series.points if not math.isnan(value)]
    return min(values, default=0.0), max(values, default=0.0)


def _nice(least: float) -> float:
    """Return the least step of at least *least* that is 1, 2 or 5 times a power of ten."""
    power = 10.0 ** math.floor(math.log10(least))
    return next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= least * 0.999)


class _Entry(NamedTuple):
    """A curve in the legend, at the baseline *y* of its label."""

    x: float
    y: int
    label: str
    pen: str
    series: Series


def _legend(panel: Panel, y: int) -> Iterator[_Entry]:
    x = float(_LEFT)
    for index, (label, series) in enumerate(panel.curves):
        colour, dash = _COLOURS[index % len(_COLOURS)], _DASHES[index % len(_DASHES)]
        width = 29 + _GLYPH * len(label)
        if x > _LEFT and x + width > _WIDTH:
            x, y = float(_LEFT), y + 16
        yield _Entry(x, y, label, f'stroke="{colour}" stroke-dasharray="{dash}"', series)
        x = round(x + width + 20, 1)


def _panel(sheet: _Sheet, panel: Panel, legend: Sequence[_Entry], bottom: int) -> Iterator[str]:
    scale = _Scale(panel, bottom)
    for tick in scale.ticks:
        yield f'<path class="grid" d="M{_LEFT} {scale.y(tick)}H{_WIDTH - _RIGHT}"/>'
        yield _text(f"{tick:.12g}", _LEFT - 6, scale.y(tick) + 4, "end")
    if panel.units:
        units, middle = _escaped(panel.units), bottom - _HEIGHT // 2
        yield f'<text transform="translate(14 {middle}) rotate(-90)" text-anchor="middle">{units}</text>'
    for x, y, label, pen, series in legend:
        yield f'<path class="curve" {pen} d="M{x} {y - 4}h24"/>{_text(label, x + 29, y)}'
        yield f'<path class="curve" {pen} d="{_path(sheet, scale, series)}"/>'
    for label, series in panel.limits:
        yield f'<path class="limit" d="{_path(sheet, scale, series)}"/>'
        yield _text(label, _WIDTH - _RIGHT - 2, scale.y(series.points[-1][1]) - 4, "end", "note")
    yield f'<path class="axis" d="M{_LEFT} {bottom - _HEIGHT}V{bottom}H{_WIDTH - _RIGHT}"/>'


def _text(text: str, x: float, y: float, anchor: str = "start", kind: str = "") -> str:
    named = f' class="{kind}"' if kind else ""
    return f'<text{named} x="{x:g}" y="{y:g}" text-anchor="{anchor}">{_escaped(text)}</text>'


def _escaped(text: str) -> str:
    """Return a text for XML, which control characters would break."""
    return html.escape(printable(text))


# ---- curves


def _path(sheet: _Sheet, scale: _Scale, series: Series) -> str:
    """Return a curve. Of the values in half a pixel, only those that show are drawn."""
    commands, before = [], math.nan
    for x, values in _columns(sheet, series):
        for value in values:
            y = "" if math.isnan(value) else f"{scale.y(value):g}"
            if not math.isnan(before):
                step = f"H{x:g}V{y}" if y else f"H{x:g}"
                commands.append(step if series.is_stepped or not y else f"L{x:g} {y}")
            elif y:
                commands.append(f"M{x:g} {y}")
            before = value
    if not math.isnan(before):  # no record comes for what does not change
        commands.append(f"H{sheet.x(sheet.end):g}")
    return "".join(commands)


def _columns(sheet: _Sheet, series: Series) -> Iterator[tuple[float, list[float]]]:
    """Yield the first, least, greatest and last value in each half of a pixel."""
    for x, points in groupby(series.points, key=lambda point: round(2.0 * sheet.x(point[0])) / 2.0):
        column = [value for _, value in points]
        if len(column) > 4:
            known = [value for value in column if not math.isnan(value)] or column[:1]
            column = [column[0], min(known), max(known), column[-1]]
        yield x, column


# ---- time


def _time_axis(sheet: _Sheet, bottom: int) -> Iterator[str]:
    length = sheet.end - sheet.start
    unit, size = next((each for each in (("h", 3600.0), ("min", 60.0)) if length >= 3 * each[1]), ("s", 1.0))
    step = _nice(length / size / 8 or 1.0)
    first, last = sheet.start / size / step, sheet.end / size / step
    for number in range(math.ceil(first - 1e-9), math.floor(last + 1e-9) + 1):
        x = sheet.x(number * step * size)
        label = _text(f"{number * step:.12g}", x, bottom + 18, "middle")
        yield f'<path class="axis" d="M{x} {bottom}v5"/>{label}'
    yield _text(f"time ({unit})", _WIDTH - _RIGHT, bottom + 36, "end")


def _failures(sheet: _Sheet, failed: Sequence[Failure], bottom: int) -> Iterator[str]:
    """Yield a mark on the time axis for each failure, and the legend of marks."""
    at = float(_LEFT)
    for kind, is_handled, how in (("handled", True, "failed, then handled"), ("failed", False, "failed")):
        found = [each for each in failed if each.is_handled == is_handled]
        for x in sorted({round(sheet.x(each.t)) for each in found}):
            yield _mark(kind, x, bottom)
            if not is_handled:
                yield f'<path class="failed faint" d="M{x} {_HEAD}V{bottom}"/>'
        if found:
            goals = {each.goal for each in found}
            name = cut(goals.pop(), _MOST_SIGNS) if len(goals) == 1 else "goals"
            text = f"{len(found)} × {name} {how}"
            yield _mark(kind, at + 4, bottom + 36) + _text(text, at + 14, bottom + 36, "start", "note")
            at = round(at + 34 + _GLYPH * len(text), 1)


def _mark(kind: str, x: float, y: int) -> str:
    return f'<path class="{kind}" d="M{x} {y}l-4 -8h8z"/>'
