"""The room on the page: panes that you divide, tabs in one row, values that wrap at their separators, a phone."""

from collections.abc import Sequence

import pytest
from devtools import Page, needs_chromium, replayed

from jacaros.look.page.recorder import Recorder
from jacaros.look.page.scene import RobotView
from jacaros.look.records.recording import Recording
from jacaros.robots.world import World

LONG = "planned_route(corridor_of_the_second_floor,/robot_1/battery_state,depot_in_the_cellar)"
LINE = f"+!g <- {'!some_goal; ' * 7}.print(done).".ljust(100, "%")
"""A line of a program, 100 columns wide."""
RIGHT = "[aria-controls=right]"


def recording(robots: Sequence[tuple[str, float]] = (("left", -1.0), ("right", 1.0))) -> Recording:
    """A run of robots, each with its name and x, and of an agent with a belief and a program."""
    recorder = Recorder()
    recorder.world(World.load("flat").description.drawing())
    for t in (0.0, 5.0):
        recorder.frame(t, [RobotView(name, x, 0.0, 0.0, 80.0, False) for name, x in robots])
    recorder.event(1.0, "agent", {"agent": "a", "state": "began"})
    recorder.event(1.0, "belief", {"agent": "a", "belief": LONG, "op": "+"})
    recorder.event(1.0, "source", {"file": "a.asl", "text": f"b.\n{LINE}"})
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
        await page.reload()
        await page.wait_for(f"document.querySelector('{RIGHT}')?.checkVisibility()")
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


@needs_chromium
async def test_a_line_of_100_columns_fits_beside_the_map_or_scrolls_by_keyboard() -> None:
    async with replayed(recording()) as page:
        await page.resize(1440, 900)
        await page.click("#tab-program")
        now = await page.text("#now")
        await page.wait_for("document.querySelector('.listing').scrollWidth > 600")
        await page.evaluate("document.querySelector('.listing').focus()")
        await page.press("ArrowRight")
        await page.wait_for("document.querySelector('.listing').scrollLeft > 0")
        assert await page.text("#now") == now
        await page.evaluate(f"document.querySelector('{RIGHT}').focus()")
        for _ in range(10):
            await page.press("ArrowLeft")
        await page.wait_for(
            "document.querySelector('.listing').scrollWidth <= document.querySelector('.listing').clientWidth"
        )
        assert await size(page, "#left", "width") > 400


@needs_chromium
async def test_values_wrap_at_their_separators() -> None:
    async with replayed(recording()) as page:
        await page.click("#tab-agents")
        await page.resize(1000, 800)
        await page.wait_for("document.querySelector('.beliefs code')?.getClientRects().length > 1")
        broken = await page.evaluate(
            "[...document.querySelector('.beliefs code').childNodes].filter((part) => part.nodeType === Node.TEXT_NODE)"
            ".filter((part) => { const range = document.createRange(); range.selectNode(part);"
            " return range.getClientRects().length !== 1; }).map((part) => part.data)"
        )
        assert broken == []
        assert await page.text(".beliefs code") == LONG


@needs_chromium
@pytest.mark.parametrize("width", [1440, 1280, 390])
async def test_tabs_are_in_one_row(width: int) -> None:
    async with replayed(recording()) as page:
        await page.resize(width, 800, mobile=width < 500)
        await page.wait_for(f"innerWidth === {width}")
        tops, room, needed = await page.evaluate(
            "(() => { const tabs = [...document.querySelectorAll('.tab')], list = document.querySelector('#tabs');"
            " for (const each of tabs) each.hidden = false;"
            " return [tabs.map((each) => each.getBoundingClientRect().top), list.clientWidth, list.scrollWidth]; })()"
        )
        assert len(tops) >= 8
        assert len(set(tops)) == 1
        assert needed <= room or width < 500, "all tabs are seen, but on a phone"


@needs_chromium
async def test_names_of_robots_do_not_overlap() -> None:
    crowd = [(f"robot_{n}", 0.25 * n) for n in range(12)]
    async with replayed(recording(crowd)) as page:
        await page.evaluate(
            "window.named = new Map(); const draw = CanvasRenderingContext2D.prototype.fillText;"
            "CanvasRenderingContext2D.prototype.fillText = function (text, x, y) {"
            " if (this.canvas.closest('#map')) named.set(text, [x, y, this.measureText(text).width]);"
            " draw.call(this, text, x, y); }"
        )
        await page.press("ArrowRight")
        await page.wait_for("window.named.size > 0")
        texts = await page.evaluate("[...named.keys()]")
        boxes = await page.evaluate("[...named.values()]")
        assert len(boxes) > 5, texts
        left, right, top = await page.evaluate(
            "(() => { const map = document.querySelector('#map canvas').getBoundingClientRect(),"
            " box = document.querySelector('#map .layers').getBoundingClientRect();"
            " return [box.left - map.left, box.right - map.left, box.top - map.top]; })()"
        )
        on_buttons = [x + width / 2 > left and x - width / 2 < right and y > top for x, y, width in boxes]
        assert not any(on_buttons), texts
        for n, (x, y, width) in enumerate(boxes):
            for other_x, other_y, other_width in boxes[:n]:
                assert abs(x - other_x) >= (width + other_width) / 2 or abs(y - other_y) >= 12
        assert any(text.isdigit() for text in texts), "where there is no room, the number"


@needs_chromium
async def test_a_phone_shows_the_agents_above_the_fold_and_has_room_for_fingers() -> None:
    async with replayed(recording()) as page:
        await page.click("#tab-agents")
        await page.resize(390, 844, mobile=True)
        await page.wait_for("innerWidth === 390")
        fold = await size(page, "#timeline", "top")
        assert await size(page, ".section > summary", "bottom") < fold
        low = await page.evaluate(
            "[...document.querySelectorAll('#tabs .tab, #play, #theme, #help, select, .section > summary')]"
            ".filter((each) => each.checkVisibility() && each.getBoundingClientRect().height < 40)"
            ".map((each) => each.outerHTML)"
        )
        assert low == []


@needs_chromium
async def test_a_question_mark_lists_the_keys() -> None:
    async with replayed(recording()) as page:
        await page.press("?")
        await page.wait_for("document.querySelector('#keys').open")
        assert "play or pause" in await page.text("#keys")
        await page.press("Escape")
        await page.wait_for("!document.querySelector('#keys').open")
