"""The pictures of the page: paired differences, dose and response, and outcomes, each with intervals where it compares."""

from collections.abc import Iterator, Sequence
from math import ceil

from drawing import bar, curve, dot, line, picture, words
from family import AGENTS, BASELINE, DONE, ENDS, SILENT, Comparison, Runs, count
from response import DOSES, Bin, Curve, Dose, bins, fit

_PANELS = {DONE: "H1: share that is done", SILENT: "H2: share that fails in silence"}
_NAMES, _PANEL, _GAP, _TOP, _ROW = 118, 280, 44, 62, 42
"""Layout of the differences in pixels: width of the names and of a panel, gap, upper margin, height of a row."""


def differences(found: Sequence[Comparison]) -> str:
    """Draw the family: for each scenario the difference of agents and baseline, with its interval."""
    rows = len(found) // len(_PANELS)
    width, height = _NAMES + 2 * _PANEL + 2 * _GAP, _TOP + rows * _ROW + 46
    limits = [abs(limit) for each in found for limit in each.interval]
    scale = max(20, 20 * ceil(5 * max(limits)))
    parts = [words(16, 24, "Agents minus baseline, in percentage points, with intervals of 95 %", "title")]
    for place, (end, title) in enumerate(_PANELS.items()):
        middle = _NAMES + place * (_PANEL + _GAP) + _PANEL / 2
        parts += _axis(title, middle, scale, rows)
        for row, each in enumerate([each for each in found if each.what == end]):
            parts += _difference(each, middle, _TOP + row * _ROW + 26, _PANEL / 2 / scale)
    names = [each.scenario.replace("_", " ") for each in found[:rows]]
    parts += [words(16, _TOP + row * _ROW + 30, name) for row, name in enumerate(names)]
    parts.append(words(16, height - 10, "full: a difference was shown; hollow: none was", "small"))
    about = "; ".join(f"{each.scenario}, {each.what}: {each.text}" for each in found)
    return picture(f"Differences of agents and baseline in percentage points: {about}", width, height, parts)


def _axis(title: str, middle: float, scale: int, rows: int) -> Iterator[str]:
    bottom = _TOP + rows * _ROW + 4
    yield words(middle, 48, title, "", "middle")
    for part in (-1.0, -0.5, 0.0, 0.5, 1.0):
        x = middle + part * _PANEL / 2
        yield line(x, _TOP, x, bottom, "grid" if part else "axis")
        yield words(
            x, bottom + 14, f"{part * scale:+.0f}".replace("-", "−") if part else "0", "small", "middle"
        )


def _difference(each: Comparison, middle: float, y: float, unit: float) -> Iterator[str]:
    at, low, high = (middle + 100 * unit * value for value in (each.pairs.difference, *each.interval))
    style = each.winner or AGENTS
    yield line(low, y, high, y, style)
    yield dot(at, y, style if each.shown else f"{style} open", f"{each.scenario}, {each.what}: {each.text}")
    inside = max(middle - _PANEL / 2 + 46, min(middle + _PANEL / 2 - 46, at))
    yield words(inside, y - 9, each.text, "small", "middle")


# ---- dose and response

_ACROSS, _PLOT_WIDTH, _PLOT_HEIGHT = 3, 190, 110
_CELL_WIDTH, _CELL_HEIGHT = 240, 190
_SHIFT = {AGENTS: -3, BASELINE: 3}
"""Pixels between the points of both sides, so that neither hides the other."""


def responses(outcomes: Runs) -> str:
    """Draw for each kind of disturbance the share that is done by dose: five bins with intervals, and a fitted curve."""
    kinds = [kind for kind in DOSES if any(each.kind == kind for each in outcomes)]
    height = 60 + _CELL_HEIGHT * ceil(len(kinds) / _ACROSS)
    parts = [words(16, 24, "Share of the runs that is done, by dose, with intervals of 95 %", "title")]
    for number, side in enumerate(_SHIFT):
        parts += [dot(22 + 80 * number, 42, side, side), words(32 + 80 * number, 46, side)]
    for number, kind in enumerate(kinds):
        x, y = 40 + number % _ACROSS * _CELL_WIDTH, 84 + number // _ACROSS * _CELL_HEIGHT
        parts += _plot(x, y, kind, DOSES[kind])
        for side in _SHIFT:
            runs = [
                (each.dose, each.end == DONE) for each in outcomes if (each.kind, each.side) == (kind, side)
            ]
            parts += _response(x, y, side, bins(runs, DOSES[kind]), fit(runs, DOSES[kind]))
    about = f"Share of runs that is done by dose, for agents and baseline: {', '.join(kinds)}"
    return picture(about, 20 + _ACROSS * _CELL_WIDTH, height, parts)


def _plot(x: float, y: float, kind: str, dose: Dose) -> Iterator[str]:
    yield words(x, y - 9, kind)
    for part in (0.0, 0.5, 1.0):
        level = y + _PLOT_HEIGHT * (1 - part)
        yield line(x, level, x + _PLOT_WIDTH, level, "grid" if part else "axis")
        yield words(x - 5, level + 4, f"{100 * part:.0f}", "small", "end")
        value = dose.text(dose.low + part * (dose.high - dose.low))
        yield words(x + part * _PLOT_WIDTH, y + _PLOT_HEIGHT + 15, value, "small", "middle")
    yield words(x + _PLOT_WIDTH / 2, y + _PLOT_HEIGHT + 31, dose.name, "small", "middle")


def _response(x: float, y: float, side: str, found: Sequence[Bin], fitted: Curve) -> Iterator[str]:
    low, high = fitted.dose.low, fitted.dose.high

    def across(dose: float) -> float:
        return x + (dose - low) / (high - low) * _PLOT_WIDTH

    def up(share: float) -> float:
        return y + (1 - share) * _PLOT_HEIGHT

    doses = [low + number * (high - low) / 24 for number in range(25)]
    if any(each.runs for each in found):
        yield curve([(across(each), up(fitted.done(each))) for each in doses], side)
    for each in found:
        if each.runs:
            at = across((each.low + each.high) / 2) + _SHIFT[side]
            yield line(at, up(each.interval.low), at, up(each.interval.high), side)
            yield dot(at, up(each.done / each.runs), side, f"{side}: {each.done} of {each.runs} done")


# ---- outcomes

_LABELS, _BAR_WIDTH, _BAR_HEIGHT = 200, 460, 16


def outcomes_by_side(outcomes: Runs, sides: Sequence[str], scenarios: Sequence[str]) -> str:
    """Draw the three outcomes of each side in each scenario, as parts of a bar."""
    parts = [words(16, 24, "Outcomes of disturbed runs", "title")]
    for number, end in enumerate(ENDS):
        x = _LABELS + 90 * number
        parts += [bar(x, 34, 12, 12, end), words(x + 17, 44, end)]
    y, told = 62, []
    for scenario in scenarios:
        parts.append(words(16, y + 12, scenario.replace("_", " "), "title"))
        y += 20
        for side in sides:
            runs = [each for each in outcomes if (each.scenario, each.side) == (scenario, side)]
            if runs:
                parts += [words(_LABELS - 8, y + 12, side, "", "end"), *_bar(y, runs)]
                told.append(f"{scenario}, {side}: " + ", ".join(f"{count(runs, end)} {end}" for end in ENDS))
                y += 20
        y += 6
    return picture(f"Outcomes of disturbed runs: {'; '.join(told)}", _LABELS + _BAR_WIDTH + 60, y + 6, parts)


def _bar(y: float, runs: Runs) -> Iterator[str]:
    x = float(_LABELS)
    for end in ENDS:
        number = count(runs, end)
        width = _BAR_WIDTH * number / len(runs)
        if number:
            yield bar(x, y, width, _BAR_HEIGHT, end, f"{number} of {len(runs)} {end}")
        if width > 22:
            yield words(x + width / 2, y + 12, str(number), "dark" if end == "told" else "in", "middle")
        x += width
    yield words(x + 8, y + 12, f"of {len(runs)}", "small")
