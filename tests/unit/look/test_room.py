"""The room on the page: panes that you divide, tabs in one row, values that wrap at their separators, a phone."""

from collections.abc import Sequence

import pytest
from devtools import Page, needs_chromium, replayed

from jacaros.look.page.recorder import Recorder
from jacaros.look.page.scene import RobotView
from jacaros.look.records.recording import Recording
from jacaros.robots.world import World

LONG = "connected(corridor_of_the_second_floor,/robot_1/battery_state,depot_in_the_cellar)"
RIGHT = "[aria-controls=right]"


def recording(robots: Sequence[tuple[str, float]] = (("left", -1.0), ("right", 1.0))) -> Recording:
    """A run of robots, each with its name and x, and of an agent with a belief and a program."""
    recorder = Recorder()
    recorder.world(World.load("flat").description.drawing())
    for t in (0.0, 5.0):
        recorder.frame(t, [RobotView(name, x, 0.0, 0.0, 80.0, False) for name, x in robots])
    recorder.event(1.0, "agent", {"agent": "a", "what": "created"})
    recorder.event(1.0, "belief", {"agent": "a", "belief": LONG, "op": "+"})
    recorder.text(2.0, "a", "hello")
    recorder.close()
    return recorder.recording


async def size(page: Page, selector: str, side: str) -> float:
    return float(await page.evaluate(f"document.querySelector('{selector}').getBoundingClientRect().{side}"))


@needs_chromium
async def test_a_divider_is_dragged_remembered_and_reset() -> None:
    async with replayed(recording()) as page:
        wide = await size(page, "#right", "width")
        x = await page.evaluate(f"document.querySelector('{RIGHT}').getBoundingClientRect().x") + 6
        await page.drag(x, 300, x - 200, 300)
        await page.wait_for(f"document.querySelector('#right').getBoundingClientRect().width > {wide + 180}")
        dragged = await size(page, "#right", "width")
        assert dragged == pytest.approx(wide + 200, abs=15)
        await page.evaluate("window.isOld = true; location.reload()")
        await page.wait_for(f"!window.isOld && document.querySelector('{RIGHT}')?.ariaValueNow")
        assert await size(page, "#right", "width") == pytest.approx(dragged, abs=2)
        await page.evaluate(f"document.querySelector('{RIGHT}').dispatchEvent(new MouseEvent('dblclick'))")
        assert await size(page, "#right", "width") == pytest.approx(wide, abs=1)


@needs_chromium
async def test_arrow_keys_move_a_divider_and_not_the_time() -> None:
    async with replayed(recording()) as page:
        now = await page.text("#now")
        high = await size(page, "#log", "height")
        await page.evaluate("document.querySelector('[aria-controls=log]').focus()")
        for _ in range(3):
            await page.press("ArrowUp")
        assert await size(page, "#log", "height") > high + 20
        value = await page.evaluate("document.activeElement.getAttribute('aria-valuenow')")
        await page.press("ArrowDown")
        assert await page.evaluate("document.activeElement.getAttribute('aria-valuenow')") < value
        assert await page.text("#now") == now
        await page.press("Enter")
        assert await size(page, "#log", "height") == pytest.approx(high, abs=1)


@needs_chromium
async def test_panes_keep_a_least_size() -> None:
    async with replayed(recording()) as page:
        await page.evaluate(f"document.querySelector('{RIGHT}').focus()")
        await page.press("Home")
        assert await size(page, "#left", "width") > 100
        await page.press("End")
        assert await size(page, "#right", "width") > 100
