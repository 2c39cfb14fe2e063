"""The controls of the live page in a real browser: pause, step, breakpoints, console, and errors at the control."""

from devtools import Page, browsing

PROGRAM = """
count(0).
!live.
+!live <- !tick; .wait(50); !live.
+!tick : count(N)
   <- -+count(N + 1).
+ready <- .print(steady).
"""
on_the_page = browsing(PROGRAM, ".intention")


SHOWN = """Number([...document.querySelectorAll('.beliefs code')].map((each) =>
    /^count\\((\\d+)/.exec(each.innerText)?.[1]).find(Boolean))"""
"""The count that the page shows."""


def count(page: Page) -> int:
    """The count of the agent itself."""
    found = page.mas.agent("bob").ask("count(N)")
    assert found is not None
    return int(found["N"])


async def say(page: Page, line: str) -> None:
    """Write a line into the console."""
    await page.evaluate("document.querySelector('.console .entry').focus()")
    await page.type(line)
    await page.press("Enter")


def last(kind: str) -> str:
    return f"[...document.querySelectorAll('.console .{kind}')].at(-1)?.innerText"


@on_the_page
async def test_pause_stops_the_run_and_a_step_advances_it(page) -> None:
    await page.evaluate("document.querySelector('.pause-run').focus()")
    await page.press("Enter")
    await page.wait_for("document.querySelector('.debug-state').innerText.includes('Paused')")
    assert page.mas.debugger.paused
    held = count(page)
    await page.wait_for("document.querySelector('.pause-run').innerText.includes('Continue')")
    assert count(page) == held
    await page.click(".group button")
    await page.wait_for("document.querySelector('.debug-state').innerText.includes('bob')")
    await page.click(".pause-run")
    await page.wait_for("!document.querySelector('.debug-state').checkVisibility()")
    assert not page.mas.debugger.paused
    await page.wait_for(f"{SHOWN} > {held + 1}")
    assert count(page) > held + 1


@on_the_page
async def test_a_breakpoint_on_a_line_hits_and_shows_the_line(page) -> None:
    await page.click("#tab-program")
    await page.wait_for("document.querySelectorAll('.code-line').length > 5")
    lines = "[...document.querySelectorAll('.code-line')]"
    number = f"{lines}.find((each) => each.innerText.includes('-+count')).firstElementChild"
    await page.evaluate(f"{number}.focus()")
    await page.press("Enter")
    await page.wait_for("document.querySelector('.code-line.held')")
    await page.wait_for("document.querySelector('.debug-state').innerText.includes('breakpoint')")
    await page.wait_for("document.querySelector('.code-line.held.current')")
    assert await page.texts(".popover summary") == ["Breakpoints (1)"]
    await page.reload()
    await page.wait_for("document.querySelector('.popover summary')?.innerText === 'Breakpoints (1)'")
    await page.click(".popover summary")
    await page.click(".breakpoints .act")
    await page.wait_for("!document.querySelector('.code-line.held')")
    await page.press("Escape")
    await page.wait_for("!document.querySelector('.popover').open")
    await page.click(".pause-run")
    await page.wait_for("!document.querySelector('.debug-state').checkVisibility()")


@on_the_page
async def test_a_breakpoint_without_a_line_is_rejected_at_the_field(page) -> None:
    await page.click(".popover summary")
    await page.click(".window .entry")
    await page.type("patrol")
    await page.press("Enter")
    await page.wait_for("document.querySelector('.bubble')?.innerText.includes('expected a file and a line')")


@on_the_page
async def test_a_breakpoint_on_a_condition_is_set_and_an_invalid_one_rejected(page) -> None:
    await page.click(".popover summary")
    await page.evaluate(
        "(() => { const kind = document.querySelector('.window select'); kind.value = 'condition';"
        "kind.dispatchEvent(new Event('change')); })()"
    )
    await page.click(".window .entry")
    await page.type("count(N &")
    await page.press("Enter")
    await page.wait_for("document.querySelector('.bubble[role=alert]')")
    await page.evaluate("document.querySelector('.window .entry').select()")
    await page.type("count(N) & N mod 7 == 0")
    await page.press("Enter")
    await page.wait_for("document.querySelector('.debug-state').innerText.includes('N mod 7')")
    assert count(page) % 7 == 0


@on_the_page
async def test_the_console_asks_adds_and_removes_and_remembers(page) -> None:
    await say(page, "?count(N)")
    await page.wait_for(f"{last('answer')}?.startsWith('N = ')")
    await say(page, "+ready")
    await page.wait_for("document.querySelector('#log').innerText.includes('steady')")
    await page.wait_for(
        "[...document.querySelectorAll('.beliefs code')].some((each) => each.innerText === 'ready')"
    )
    assert page.mas.agent("bob").believes("ready")
    await page.click("[aria-label='Remove ready']")
    await page.wait_for(
        "![...document.querySelectorAll('.beliefs li:not(.gone) code')].some((each) => each.innerText === 'ready')"
    )
    assert not page.mas.agent("bob").believes("ready")
    await say(page, "!nothing(")
    await page.wait_for(last("error"))
    await page.press("ArrowUp")
    await page.press("ArrowUp")
    assert await page.evaluate("document.activeElement.value") == "+ready"


@browsing("!live.\n+!live <- .wait({+never}).", ".intention")
async def test_a_goal_is_dropped_at_its_card(page) -> None:
    await page.click("[aria-label='Drop !live']")
    await page.wait_for("!document.querySelector('.intention')")
    assert "live" not in str(page.mas.agent("bob").goals)


@on_the_page
async def test_a_button_receives_clicks_while_its_card_changes(page) -> None:
    x, y = await page.evaluate(
        "(() => { const box = document.querySelector('.intention .ask').getBoundingClientRect();"
        "return [box.x + box.width / 2, box.y + box.height / 2]; })()"
    )
    mouse = {"x": x, "y": y, "button": "left", "clickCount": 1}
    await page.call("Input.dispatchMouseEvent", type="mousePressed", buttons=1, **mouse)
    before = count(page)
    while count(page) < before + 6:
        await page.evaluate("1")
    await page.call("Input.dispatchMouseEvent", type="mouseReleased", **mouse)
    await page.wait_for("document.querySelector('#causes').checkVisibility()")
