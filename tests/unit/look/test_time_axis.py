"""The axis of lanes and curves: zoom, pan, and how it follows a run and its moment."""

import json
from pathlib import Path
from typing import Any

from devtools import needs_chromium
from test_page_models import evaluated

Cases = dict[str, tuple[list[str], list[float]]]
"""By name: steps, and the range that is shown after them."""


def shown(tmp_path: Path, live: bool, cases: Cases) -> Any:
    """Return the range after the steps of each case, on the axis of a run of 1,000 s that is shown with 100 pixels."""
    flag = json.dumps(live)
    parts = [
        f"""(() => {{
          const time = {{ run: {{ end: 1000 }}, now: 0, live: {flag}, canBeLive: {flag}, playing: false }};
          const axis = new TimeAxis(time), go = (t) => {{ time.now = t; axis.update(t); }};
          Object.assign(axis, {{ left: 10, width: 100 }});
          {"; ".join(steps)};
          return [axis.from, axis.to].map((t) => Math.round(t * 100) / 100);
        }})()"""
        for steps, _ in cases.values()
    ]
    found = evaluated(tmp_path, "time_axis", "TimeAxis", f"[{', '.join(parts)}]")
    return dict(zip(cases, found, strict=True))


def expected(cases: Cases) -> dict[str, list[float]]:
    return {name: part for name, (_, part) in cases.items()}


@needs_chromium
def test_a_recording_is_shown_whole_until_you_zoom_and_its_moment_stays_in_view(tmp_path: Path) -> None:
    part = "axis.show(100, 200)"
    cases: Cases = {
        "whole": (["go(0)"], [0, 1000]),
        "zoom": (["go(0)", "axis.zoom(4, 200)"], [150, 400]),
        "zoom out": (["go(0)", "axis.zoom(4, 200)", "axis.zoom(1 / 4, 200)"], [0, 1000]),
        "pan to the end": (["go(0)", "axis.zoom(4, 200)", "axis.pan(10000)"], [800, 1050]),
        "move inside": (["go(0)", part, "go(150)"], [100, 200]),
        "jump": (["go(0)", part, "go(500)"], [450, 550]),
        "play": (["go(150)", part, "time.playing = true", "go(195)"], [105, 205]),
        "play elsewhere": (["go(500)", part, "time.playing = true", "go(510)"], [100, 200]),
        "all": (["go(0)", part, "axis.all()", "go(0)"], [0, 1000]),
    }
    assert shown(tmp_path, False, cases) == expected(cases)


@needs_chromium
def test_a_live_run_is_followed_until_you_look_elsewhere(tmp_path: Path) -> None:
    early, grow = "axis.show(100, 200)", "time.run.end = 1008"
    back = ["time.live = false", "go(150)", "time.live = true", "go(1000)"]
    cases: Cases = {
        "end": (["go(1000)"], [892, 1012]),
        "young": (["time.run.end = 20", "go(20)"], [0, 22.22]),
        "zoomed": (["go(1000)", "axis.show(900, 1010)", grow, "go(1008)"], [909, 1019]),
        "elsewhere": (["go(1000)", early, grow, "go(1008)"], [100, 200]),
        "follow": (["go(1000)", early, "axis.follow()", "go(1000)"], [892, 1012]),
        "back to live": (["go(1000)", early, *back], [892, 1012]),
    }
    assert shown(tmp_path, True, cases) == expected(cases)
