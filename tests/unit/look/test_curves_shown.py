"""Curves over time: numbers found in records, drawn at any scale, with what contexts compare."""

import json
from pathlib import Path
from typing import Any

import pytest
from devtools import Page, needs_chromium, replayed
from test_page_models import evaluated

from jacaros.look.page.recorder import Recorder
from jacaros.look.page.scene import RobotView
from jacaros.look.records.recording import Recording

WORLD = {"name": "lab", "bounds": [0, 0, 5, 5], "robots": [{"name": "r1", "pose": [0, 0, 0], "radius": 0.2}]}
PLAN = {"id": 7, "trigger": "+!go", "label": "charge", "context": "", "file": "bob.asl", "line": 1, "end": 1}
THRESHOLDS = [
    {"belief": "battery", "argument": 0, "operator": "<", "value": 20.0, "plan": 7},
    {"belief": "battery", "argument": 0, "operator": "<", "other": "limit", "rule": "low"},
]


def believed(op: str, belief: str) -> dict[str, Any]:
    return {"agent": "bob", "op": op, "belief": f"{belief}[source(self)]"}


def recorded() -> Recording:
    """A robot that drives, and an agent that believes that its battery falls from 90 to 10 in 40 s."""
    recorder = Recorder()
    recorder.world(WORLD)
    recorder.event(0.0, "program", {"agent": "bob", "plans": [PLAN], "rules": [], "thresholds": THRESHOLDS})
    for belief in ("limit(30)", "place(1,2)", "place(3,4)", "mode(slow)", "battery(90)"):
        recorder.event(0.0, "belief", believed("+", belief))
    recorder.event(
        0.0, "property", {"artifact": "/main/a", "name": "pose", "key": 1, "values": [1.5, "map", 7]}
    )
    for second in range(1, 41):
        recorder.frame(float(second), [RobotView("r1", second * 0.1, 1.0, 0.0, 90.0)])
        recorder.event(float(second), "belief", believed("-", f"battery({92 - 2 * second})"))
        recorder.event(float(second), "belief", believed("+", f"battery({90 - 2 * second})"))
        option = {"plan": 7, "why": "stops at `B < 20`"}
        deliberation = {"id": second, "agent": "bob", "trigger": "+!go", "chosen": None, "options": [option]}
        recorder.event(float(second), "deliberation", {**deliberation, "untried": []})
    recorder.close()
    return recorder.recording


async def chips(page: Page) -> list[str]:
    return [" ".join(text.split()[:-2]) for text in await page.texts(".chip")]  # without its buttons


EXTREMES = """(() => {
  const track = { times: [], values: [] }, series = new Series(track);
  let seed = 7;
  const random = (n) => { seed = (seed * 16807) % 2147483647; return seed % n; };
  const wrong = [];
  for (let n = 0; n < 9000; n++) {
    track.times.push(n / 10); track.values.push(random(20) ? random(1000) : NaN);
    if (n === 7000) for (const list of [track.times, track.values]) list.splice(0, 3000);
    if (n % 100) continue;
    series.grow();
    const from = random(track.values.length), to = from + random(track.values.length - from + 1);
    const expected = track.values.slice(from, to).filter((value) => !Number.isNaN(value));
    const [low, high] = series.extremes(from, to);
    if (low !== Math.min(...expected) || high !== Math.max(...expected)) wrong.push([from, to]);
  }
  return wrong;
})()"""

POINTS = """(() => {
  const track = { times: [], values: [] }, series = new Series(track);
  for (let n = 0; n < 200000; n++) { track.times.push(n / 10); track.values.push(n === 123456 ? 99 : Math.sin(n / 5000)); }
  series.grow();
  const all = series.points(0, 20000, 25, false), some = series.points(12345, 12347, 0.0025, false);
  return [all.length / 4, Math.max(...all.filter((_, i) => i % 2)), some.length / 2];
})()"""


@needs_chromium
def test_the_pyramid_has_the_extremes_of_any_stretch(tmp_path: Path) -> None:
    assert evaluated(tmp_path, "series", "Series", EXTREMES) == []


@needs_chromium
def test_a_long_curve_has_two_points_for_each_pixel_and_keeps_its_peaks(tmp_path: Path) -> None:
    pixels, peak, near = evaluated(tmp_path, "series", "Series", POINTS)
    assert pixels <= 801
    assert peak == 99
    assert near == 22, "every sample when few are in view, one before them, and one after"


@needs_chromium
async def test_what_contexts_compare_and_where_the_robot_is_are_drawn_at_first() -> None:
    async with replayed(recorded(), at=30.0) as page:
        assert await chips(page) == ["bob:battery 30 %", "r1.x 3 m", "r1.y 1 m"]
        titles = await page.evaluate("[...document.querySelector('.more').options].map((each) => each.text)")
        assert {"bob:limit", "r1.speed", "a:pose.1"} <= set(titles)
        assert not any("place" in title for title in titles), "several at one time are not one number"


@needs_chromium
async def test_curves_are_chosen_where_numbers_are_shown_and_remembered() -> None:
    async with replayed(recorded(), at=30.0) as page:
        await page.click("button[aria-label='Remove the curve of r1.x']")
        await page.click("#tab-artifacts")
        await page.click("button[aria-label^='Curve of pose']")
        await page.wait_for("document.querySelector('#artifacts .plot[aria-pressed=true]')")
        assert await chips(page) == [
            "bob:battery 30 %",
            "r1.y 1 m",
            "a:pose.1 1.5",
            "a:pose.3 7",
        ]
        await page.reload()
        await page.wait_for("document.querySelectorAll('.chip').length === 4")


DRAGGED = """(() => {
  const dataTransfer = new DataTransfer();
  const drag = (target, kind) => target.dispatchEvent(new DragEvent(kind, { dataTransfer, bubbles: true }));
  drag(document.querySelector('.robot'), 'dragstart');
  drag(document.querySelector('#curves'), 'drop');
})()"""


@needs_chromium
async def test_a_robot_is_dragged_to_the_curves() -> None:
    async with replayed(recorded(), at=30.0, more="&curves=robot r1 speed") as page:
        await page.evaluate(DRAGGED)
        await page.wait_for("document.querySelectorAll('.chip').length === 4")
        assert await chips(page) == ["r1.speed 0.1 m/s", "r1.battery 90 %", "r1.x 3 m", "r1.y 1 m"]


DRAWN = """(() => {
  const { prototype } = CanvasRenderingContext2D, fill = prototype.fillText;
  window.drawn = [];
  prototype.fillText = function (text, x, y) { window.drawn.push([text, y]); return fill.call(this, text, x, y); };
  document.querySelector('#theme').click();
})()"""


@needs_chromium
async def test_thresholds_and_folded_refusals_are_drawn_with_their_names() -> None:
    async with replayed(recorded(), at=30.0, more="&curves=belief bob battery 0") as page:
        await page.evaluate(DRAWN)
        await page.wait_for("window.drawn.some(([text]) => text === '20: @charge')")
        drawn = dict(await page.evaluate("window.drawn"))
        assert "30 limit: low" in drawn
        assert any(text.startswith("40× @charge") for text in drawn), drawn
        assert drawn["30 limit: low"] < drawn["20: @charge"] < drawn["0"]


@needs_chromium
@pytest.mark.parametrize("key", ["belief bob battery 0", "robot r1 x", "property /main/a pose 2"])
async def test_the_pointer_reads_values(key: str) -> None:
    async with replayed(recorded(), at=30.0, more=f"&curves={key}") as page:
        box = await page.evaluate(
            "(() => { const b = document.querySelector('.plot').getBoundingClientRect(); return [b.x, b.y, b.width]; })()"
        )
        await page.call("Input.dispatchMouseEvent", type="mouseMoved", x=box[0] + box[2] - 14, y=box[1] + 20)
        await page.wait_for("document.querySelector('.plot .tip').checkVisibility()")
        expected = {"belief bob battery 0": "bob:battery 12 %", "robot r1 x": "r1.x 3.99 m"}
        assert expected.get(key, "a:pose.3 7") in await page.text(".plot .tip"), json.dumps(key)


SEGMENTS = """(() => {
  const { prototype } = CanvasRenderingContext2D, { moveTo, lineTo, fillText } = prototype;
  let last = NaN;
  window.steepest = 0;
  window.texts = {};
  prototype.moveTo = function (x, y) { last = y; return moveTo.call(this, x, y); };
  prototype.lineTo = function (x, y) {
    if (this.canvas.parentElement?.matches('.plot')) window.steepest = Math.max(window.steepest, Math.abs(y - last) || 0);
    if (!Number.isNaN(y)) last = y;
    return lineTo.call(this, x, y);
  };
  prototype.fillText = function (text, x, y) {
    if (this.canvas.parentElement?.matches('.plot')) window.texts[text] = x;
    return fillText.call(this, text, x, y);
  };
  document.querySelector('#theme').click();
})()"""


@needs_chromium
async def test_a_yaw_is_broken_at_half_a_turn_and_numbers_on_the_right_have_a_margin() -> None:
    recorder = Recorder()
    recorder.world(WORLD)
    for second in range(41):
        yaw = (second * 0.2 + 3) % 6.28 - 3.14
        recorder.frame(float(second), [RobotView("r1", second * 0.1, 1.0, yaw, 90.0)])
    recorder.close()
    async with replayed(recorder.recording, at=30.0, more="&curves=robot r1 yaw;robot r1 x") as page:
        await page.evaluate(SEGMENTS)
        metres = "Object.entries(window.texts).find(([text]) => text.endsWith(' m'))"
        await page.wait_for(metres)
        width = await page.evaluate("document.querySelector('.plot').clientWidth")
        assert width - 54 < (await page.evaluate(metres))[1] < width - 30
        height = await page.evaluate("document.querySelector('.plot').clientHeight")
        assert 0 < await page.evaluate("window.steepest") < height / 3
