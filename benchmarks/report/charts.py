"""Pictures of a report, as SVG; runs in .venv-bench, where matplotlib is.

charts.py REPORT.json FOLDER
"""

import json
import re
import sys
from pathlib import Path
from typing import Any

import matplotlib as mpl

mpl.use("svg")

from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.figure import Figure

COLOURS = {"jacaros": "#1f6fb4", "agentspeak": "#d1703c", "jason": "#6b9e3a"}
NAMES = {"jacaros": "JaCaROS", "agentspeak": "python-agentspeak", "jason": "Jason"}
STYLE = {
    "svg.fonttype": "none",
    "svg.hashsalt": "benchmarks",
    "font.family": "sans-serif",
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#dddddd",
    "axes.axisbelow": True,
}


def main(report: Path, folder: Path) -> None:
    """Draw all pictures."""
    found = json.loads(report.read_text(encoding="utf-8"))
    with pyplot.rc_context(STYLE):  # type: ignore[arg-type]
        save(ratios(found["programs"]), folder / "benchmarks_programs.svg")
        save(scaling(found["scaling"]), folder / "benchmarks_scaling.svg")


def ratios(rows: list[dict[str, Any]]) -> Figure:
    """How many times as long the others take, program by program."""
    rows = [row for row in rows if any(_ratio(peer) for peer in row["peers"].values())]
    engines = list(dict.fromkeys(engine for row in rows for engine in row["peers"]))
    figure, axes = pyplot.subplots(figsize=(7.5, 0.9 + 0.28 * len(rows)), layout="constrained")
    height = 0.8 / max(1, len(engines))
    for place, engine in enumerate(engines):
        drawn = [
            (i, row["peers"][engine]) for i, row in enumerate(rows) if _ratio(row["peers"].get(engine, {}))
        ]
        values = [_ratio(peer) for _, peer in drawn]
        heights = [i + place * height for i, _ in drawn]
        axes.barh(heights, values, height, color=COLOURS[engine], label=NAMES[engine])
        for y, (_, peer), value in zip(heights, drawn, values, strict=True):
            sign = "" if "ratio" in peer else "> "
            axes.text(
                value * 1.06,
                y,
                f"{sign}{value:,.0f} ×" if value >= 10 else f"{sign}{value:.1f} ×",
                va="center",
            )
    axes.set_yticks(
        [i + height * (len(engines) - 1) / 2 for i in range(len(rows))], [row["name"] for row in rows]
    )
    axes.invert_yaxis()
    axes.set_xscale("log")
    axes.set_xlim(left=1)
    axes.margins(x=0.15)
    axes.grid(visible=False, axis="y")
    axes.set_xlabel("times as long as JaCaROS takes for the same program (logarithmic)")
    if len(engines) > 1:
        axes.legend(frameon=False)
    return figure


def _ratio(peer: dict[str, Any]) -> float:
    return float(peer.get("ratio") or peer.get("least_ratio") or 0.0)


def scaling(curves: list[dict[str, Any]]) -> Figure:
    """What a unit costs among more and more of its kind."""
    lines = -(-len(curves) // 2)
    figure, panels = pyplot.subplots(lines, 2, figsize=(7.5, 3 * lines), layout="constrained")
    for axes, curve in zip(panels.flat, curves, strict=False):
        _curve(axes, curve)
    figure.supylabel("cost in empty calls of three arguments (logarithmic)", fontsize=9)
    return figure


def _curve(axes: Axes, curve: dict[str, Any]) -> None:
    for engine, points in curve["lines"].items():
        sizes, costs = [p["size"] for p in points], [p["calls"] for p in points]
        axes.plot(sizes, costs, marker="o", markersize=4, color=COLOURS[engine], label=NAMES[engine])
    axes.set_xscale("log")
    axes.set_yscale("log")
    # From ten to a thousand at least: a flat line has to look flat.
    dearest = max(point["calls"] for points in curve["lines"].values() for point in points)
    axes.set_ylim(10, max(1000, 2 * dearest))
    axes.set_title(curve["title"], fontsize=9, loc="left")
    axes.set_xlabel(curve["among"])
    axes.legend(frameon=False, fontsize=8)


def save(figure: Figure, path: Path) -> None:
    """Write a picture that names nothing outside of itself."""
    figure.savefig(path, metadata={"Date": None, "Creator": None, "Format": None, "Type": None})
    pyplot.close(figure)
    text = path.read_text(encoding="utf-8")
    text = re.sub(r"<!DOCTYPE.*?>\n?", "", text, flags=re.DOTALL)
    text = text.replace("xlink:href", "href").replace(' xmlns:xlink="http://www.w3.org/1999/xlink"', "")
    path.write_text("\n".join(line.rstrip() for line in text.splitlines()) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
