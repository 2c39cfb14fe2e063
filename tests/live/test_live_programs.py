"""Programs that run in a page of a real browser: no server has a part in them but the one that serves files."""

import json
import sys
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest

from jacaros import run
from played import played

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "unit" / "look"))

from devtools import Page, chromium, needs_chromium

LONG = 120.0
"""Seconds in which Python has started, also on a machine that does much else."""
RUN, STOP = ".jl-bar button:nth-of-type(1)", ".jl-bar button:nth-of-type(2)"
LIVE = "document.querySelector('.jl').liveProgram"
INSIDE = "document.querySelector('.jl-page')?.contentDocument.body.innerText"


async def show(page: Page, address: str, fragment: str = "") -> None:
    """Open the page, with its editor."""
    await page.open(f"{address}live.html{fragment}")
    await page.wait_for("document.querySelector('.jl')?.liveProgram")


def in_browser(scene: Callable[..., Any]) -> Any:
    """Make a test of a coroutine function that takes a page of a browser; the page must report no error."""

    def play(inner: Callable[[Page], Awaitable[None]]) -> None:
        async def main() -> None:
            async with chromium() as page:
                await inner(page)
                assert page.errors == []

        run(main())

    return needs_chromium(played(play)(scene))


async def started(page: Page) -> None:
    await page.click(RUN)
    await page.wait_for("document.querySelector('.jl').dataset.state === 'running'", LONG)


async def edit(page: Page, program: str) -> None:
    await page.evaluate(f"{LIVE}.editor.text = {json.dumps(program)}")


@in_browser
async def test_the_robot_moves_and_its_mind_is_beside_it(page: Page, address: str) -> None:
    await show(page, address)
    await started(page)
    await page.wait_for(f"{INSIDE}.includes('corner 1')", LONG)
    text = await page.evaluate(INSIDE)
    assert "turtlebot" in text
    assert "!patrol" in text
    await page.click(STOP)
    await page.wait_for("document.querySelector('.jl').dataset.state === 'idle'")


@in_browser
async def test_a_changed_program_runs_and_an_endless_one_can_be_stopped(page: Page, address: str) -> None:
    await show(page, address, "#first_agent")
    await edit(page, '!go.\n+!go <- .print("changed"); !more(0).\n+!more(N) <- !more(N + 1).')
    await started(page)
    await page.wait_for(f"{INSIDE}.includes('changed')", LONG)
    await page.click(STOP)
    await page.wait_for("document.querySelector('.jl').dataset.state === 'idle'", LONG)


@pytest.mark.parametrize("stopped", [True, False], ids=["stopped", "running"])
@in_browser
async def test_a_program_runs_again_after_a_change(page: Page, address: str, stopped: bool) -> None:
    await show(page, address, "#first_agent")
    for word in ("first", "second", "third"):
        await edit(page, f'!go.\n+!go <- .print("{word}"); .wait(1000000).')
        await started(page)
        await page.wait_for(f"{INSIDE}?.includes('{word}')", LONG)
        if stopped:
            await page.click(STOP)
            await page.wait_for("document.querySelector('.jl').dataset.state === 'idle'", LONG)


@in_browser
async def test_an_error_has_its_line_and_help(page: Page, address: str) -> None:
    await show(page, address, "#first_agent")
    await edit(page, "!go.\n+!go <- .print(1)")
    await page.click(RUN)
    await page.wait_for("document.querySelector('.jl-log').textContent.includes('help:')", LONG)
    assert (await page.text(".jl-log")).startswith("busy.asl:2:")
    assert await page.text(".jl-status") == "The program has errors."


@in_browser
async def test_a_link_has_the_program_and_nothing_of_it_is_markup(page: Page, address: str) -> None:
    await show(page, address, "#why")
    wicked = "<img src=x onerror=document.title='wicked'>"
    await edit(page, f'!go.\n+!go <- .print("{wicked}").')
    shared = await page.evaluate(
        "import('./sharing.js').then(({ packed }) => packed({ ..."
        f"{LIVE}.source(), title: {json.dumps(wicked)} }}))"
    )
    await page.open(f"{address}live.html?again#program={shared}")
    await page.wait_for("document.querySelector('.jl')?.liveProgram")
    assert wicked in await page.evaluate(f"{LIVE}.editor.text")
    await started(page)
    await page.wait_for(f"{INSIDE}.includes('onerror')", LONG)
    assert await page.evaluate("document.title") == "JaCaROS in your browser"


@pytest.mark.parametrize("files", [{"evil.py": "1"}, {"../a.asl": "1"}, {"a.asl": 1}, "a.asl", None])
@in_browser
async def test_a_link_with_anything_else_opens_nothing(page: Page, address: str, files: object) -> None:
    await show(page, address)
    program = json.dumps({"files": files, "main": "a.asl"})
    said = await page.evaluate(
        f"import('./sharing.js').then(async ({{ packed, unpacked }}) => unpacked(await packed({program})))"
        ".then(() => 'opened', (error) => error.message)"
    )
    assert said.startswith("This link does not contain a program")


@in_browser
async def test_a_link_that_would_become_huge_is_refused(page: Page, address: str) -> None:
    await show(page, address)
    said = await page.evaluate(
        "(async () => { const stream = new Blob([' '.repeat(5e7)]).stream()"
        ".pipeThrough(new CompressionStream('deflate-raw'));"
        "const bytes = new Uint8Array(await new Response(stream).arrayBuffer()); let text = '';"
        "for (const each of bytes) text += String.fromCharCode(each);"
        "const { unpacked } = await import('./sharing.js');"
        "return unpacked(btoa(text)).then(() => 'opened', (error) => error.message); })()"
    )
    assert "too large" in said


@in_browser
async def test_an_old_browser_gets_one_clear_message(page: Page, address: str) -> None:
    await page.call("Page.addScriptToEvaluateOnNewDocument", source="delete globalThis.WebAssembly")
    await page.open(f"{address}live.html")
    await page.wait_for("document.querySelector('.jl-old')")
    assert "it lacks WebAssembly" in await page.text(".jl-old")
