"""Lanes: bars over time from records, how they merge, and what a click and the keys do with them."""

from pathlib import Path
from typing import Any

from devtools import needs_chromium, replayed
from test_page_models import evaluated

from jacaros.look.page.recorder import Recorder
from jacaros.look.records.recording import Recording

MERGED = """(() => {
  const wrong = [], bars = new Bars(false, 3000);
  let seed = 7, t = 0;
  const random = (n) => { seed = (seed * 16807) % 2147483647; return seed % n; };
  for (let n = 0; n < 5000; n++) {
    t += random(4) * random(10) / 10;
    bars.begin(t, random(4), n);
    t += random(30) / 10;
    if (n < 4999) bars.end(t);
  }
  const { starts, ends, kinds, count } = bars;
  for (let n = 0; n < 300; n++) {
    const from = random(Math.floor(t)), to = from + random(2000), grain = random(40);
    let next = starts.findIndex((_, i) => ends[i] > from - grain);
    bars.each(from, to, grain, (first, end, sums) => {
      if (first > next) wrong.push(["left out", next, first]);
      next = end;
      if (end - first > 1 && ends[end - 1] - starts[first] > grain + 1e-6) wrong.push(["too wide", first, end]);
      const expected = [0, 0, 0, 0, 0, 0, 0, 0];
      for (let i = first; i < end; i++) if (ends[i] < Infinity) expected[kinds[i]] += ends[i] - starts[i];
      const differs = (sum, kind) => sum !== expected[kind] && Math.abs(sum - expected[kind]) > 1e-6;
      if (sums.some(differs)) wrong.push(["sums", first, end]);
    });
    if (starts[next] <= to) wrong.push(["end left out", next]);
  }
  return [wrong.slice(0, 5), count, bars.whats.at(-1), bars.isOpen];
})()"""


@needs_chromium
def test_merged_bars_leave_nothing_out_and_have_the_sums_of_their_parts(tmp_path: Path) -> None:
    wrong, count, newest, is_open = evaluated(tmp_path, "lanes_bars", "Bars", MERGED)
    assert wrong == []
    assert 3000 <= count <= 3751, "the oldest are dropped"
    assert (newest, is_open) == (4999, True)


MILLION = """(() => {
  const bars = new Bars(false, 2e6), counts = [];
  for (let n = 0; n < 1e6; n++) { bars.begin(n, n % 4, n); bars.end(n + 0.5); }
  for (const seconds of [1e6, 1e5, 1e4, 1e3, 100]) {
    let calls = 0;
    bars.each(4e5, 4e5 + seconds, 3 * seconds / 1000, () => { calls += 1; });
    counts.push(calls);
  }
  return counts;
})()"""


@needs_chromium
def test_a_million_bars_are_drawn_with_as_many_strips_as_there_is_room_for(tmp_path: Path) -> None:
    counts = evaluated(tmp_path, "lanes_bars", "Bars", MILLION)
    assert all(count <= 1000 for count in counts), "on 1,000 pixels"
    assert counts[-1] == 101, "each bar of a short range"


def goal(t: float, goal: str, state: str, number: int, intention: int = 1, **more: Any) -> list[Any]:
    return [
        t,
        "goal",
        {"agent": "bob", "goal": goal, "state": state, "id": number, "intention": intention, **more},
    ]


def state(t: float, state: str, stack: str, **more: Any) -> list[Any]:
    levels = [{"goal": each} for each in stack.split()]
    return [t, "intention", {"agent": "bob", "id": 1, "state": state, "stack": levels, **more}]


def lanes(tmp_path: Path, records: list[list[Any]], expression: str) -> Any:
    fed = f"for (const [t, event, data] of {records!r}) lanes.add(t, event, data);".replace("None", "null")
    return evaluated(
        tmp_path,
        "lanes",
        "Lanes",
        f"""(() => {{
          const lanes = new Lanes(), shown = (bars) => bars.starts.map((t, i) => [t, bars.ends[i], bars.kinds[i]]);
          {fed}
          const {{ slots, refusals }} = lanes.agents.get("bob") ?? {{}};
          return {expression};
        }})()""",
    )


RUNS, ACTS, WAITS, SUSPENDED, DONE, HANDLED, FAILED = range(7)


@needs_chromium
def test_an_intention_is_a_bar_of_its_states_with_bars_of_its_goals(tmp_path: Path) -> None:
    records = [
        goal(1.0, "!tour", "pursued", 1),
        goal(2.0, "!go(1)", "pursued", 2),
        state(2.1, "waits", "!tour !go(1)", waits="the action drive", since=2.0),
        goal(3.0, "!tour", "suspended", 1),
        state(3.1, "suspended", "!tour !go(1)", reason="preempted(wheels)", since=2.0),
        goal(4.0, "!tour", "resumed", 1),
        goal(5.0, "!go(1)", "achieved", 2),
        state(5.1, "waits", "!tour", waits="0.5 s", since=5.0),
        goal(6.0, "!tour", "achieved", 1),
        state(6.1, "over", ""),
    ]
    states, goals, words, root = lanes(
        tmp_path,
        records,
        "[shown(slots[0].states), shown(slots[0].levels[0]), slots[0].states.whats.map(({ words }) => words), "
        "slots[0].states.whats[0].root]",
    )
    assert states == [[1, 2, RUNS], [2, 3, ACTS], [3, 4, SUSPENDED], [4, 5, RUNS], [5, 6, WAITS]]
    assert words == ["", "the action drive", "preempted(wheels)", "", "0.5 s"]
    assert goals == [[2, 5, DONE]]
    assert (root["goal"], root["outcome"], root["from"], root["to"]) == ("!tour", "achieved", 1, 6)


@needs_chromium
def test_a_failure_that_a_plan_handles_is_not_a_lost_goal(tmp_path: Path) -> None:
    records = [
        goal(0.0, "!tour", "pursued", 1),
        goal(0.0, "!go", "pursued", 2),
        goal(0.0, "!side", "pursued", 3, intention=2),
        goal(1.0, "!go", "failed", 2, why="blocked"),
        goal(1.0, "!tour", "failed", 1, why="blocked"),
        goal(1.0, "!tour", "pursued", 1),
        goal(1.0, "!side", "failed", 3, intention=2, why="tired"),
        goal(2.0, "!tour", "recovered", 1),
        goal(3.0, "!behaviour", "pursued", 4),
        goal(4.0, "!behaviour", "failed", 4),
    ]
    first, second, named = lanes(
        tmp_path,
        records,
        "[shown(slots[0].failures), shown(slots[1].failures), slots[0].failures.whats.map(({ goal }) => goal)]",
    )
    assert first == [[1, 1, HANDLED]], (
        "one mark for goals that fail together; none for a failure without a reason"
    )
    assert second == [[1, 1, FAILED]]
    assert named == ["!tour"]


@needs_chromium
def test_operations_and_owners_of_resources_have_bars(tmp_path: Path) -> None:
    operation = {"artifact": "/main/wheels", "operation": "go(1)", "agent": "bob", "cause": 3}
    records = [
        [0.0, "resource", {"resource": "r2/wheels", "holder": "[ann] !go"}],
        [0.0, "resource", {"resource": "r1/wheels", "holder": "[bob] !go"}],
        [1.0, "operation", {**operation, "id": 7, "state": "began"}],
        [2.0, "operation", {**operation, "id": 8, "state": "began"}],
        [3.0, "operation", {**operation, "id": 7, "state": "done"}],
        [4.0, "operation", {**operation, "id": 8, "state": "failed", "reason": "blocked"}],
        [5.0, "resource", {"resource": "r1/wheels", "holder": None}],
    ]
    rows, owner, later = lanes(
        tmp_path,
        records,
        '[lanes.artifacts.get("/main/wheels").rows.map(shown), lanes.owner("wheels", 4, "bob"), '
        'lanes.owner("wheels", 6, "bob")]',
    )
    assert rows == [[[1, 3, DONE]], [[2, 4, FAILED]]]
    assert (owner, later) == ("[bob] !go", "")


def recorded() -> Recording:
    recorder = Recorder()
    recorder.event(0.0, "run", {"name": "tour"})
    for n, agent in enumerate(["ann", "bob"]):
        told = {"agent": agent, "goal": f"!tour({n})", "id": n + 1, "intention": n + 4}
        link = {
            "agent": agent,
            "trigger": f"+!tour({n})",
            "id": n + 1,
            "parent": 0,
            "chosen": None,
            "options": [],
        }
        recorder.event(1.0, "deliberation", {**link, "intention": None, "untried": []})
        recorder.event(1.0, "goal", {**told, "state": "pursued"})
        recorder.event(8.0 + n, "goal", {**told, "state": "failed", "why": "blocked\nstep: go"})
    recorder.event(10.0, "ended", {"code": 0})
    recorder.close()
    return recorder.recording


NOW = "document.querySelector('#now').textContent"
LABELS = 130
"""Pixels before the lanes."""


@needs_chromium
async def test_a_click_goes_there_and_shows_why_and_the_wheel_zooms() -> None:
    async with replayed(recorded()) as page:
        left, top, width = await page.evaluate(
            "(({ x, y, width }) => [x, y, width])(document.querySelector('#lanes').getBoundingClientRect())"
        )
        middle = left + LABELS + (width - LABELS) * 0.5
        await page.click_at(middle, top + 12)
        await page.wait_for(f"{NOW}.startsWith('0:05.')")
        await page.wait_for(
            "document.querySelector('#causes').innerText.includes('event +!tour(0), for which')"
        )
        assert (await page.texts(".lanes-tip"))[0].split("\n")[:2] == [
            "ann: !tour(0), intention 4",
            "running 0:01.0 to 0:08.0 (7.0 s)",
        ]
        ruler = "document.querySelector('#when .ruler')"
        before = await page.evaluate(f"{ruler}.toDataURL()")
        await page.call(
            "Input.dispatchMouseEvent", type="mouseWheel", x=middle, y=top + 12, deltaX=0, deltaY=-900
        )
        await page.wait_for(f"{ruler}.toDataURL() !== {before!r}")
        await page.click("#when [aria-label='All of the run']")
        await page.wait_for(f"{ruler}.toDataURL() === {before!r}")


@needs_chromium
async def test_the_arrow_keys_move_from_bar_to_bar() -> None:
    async with replayed(recorded()) as page:
        await page.evaluate("document.querySelector('#lanes .cursor').focus()")
        for key, words in (
            ("", "ann: !tour(0)"),
            ("ArrowDown", "bob: !tour(1)"),
            ("ArrowUp", "ann: !tour(0)"),
        ):
            if key:
                await page.press(key)
            assert (await page.evaluate("document.activeElement.textContent")).startswith(words)
        picture = "document.querySelector('#lanes canvas').toDataURL()"
        await page.evaluate("new Promise((done) => requestAnimationFrame(() => done(true)))")  # the outline
        folded = await page.evaluate(picture)
        await page.press("o")
        await page.wait_for(f"{picture} !== {folded!r}")
        await page.press("o")
        await page.wait_for(f"{picture} === {folded!r}")
        await page.press("ArrowDown")
        await page.press("Enter")
        await page.wait_for(f"{NOW} === '0:01.0'")
        await page.wait_for(
            "document.querySelector('#causes').innerText.includes('event +!tour(1), for which')"
        )
