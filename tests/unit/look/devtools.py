"""Drives a headless Chromium over the DevTools protocol, for tests of the page.

::

    async with chromium() as page:
        await page.open("file:///tmp/run.html#t=3")
        await page.click("#play")
        await page.wait_for("document.querySelector('#now').textContent !== '0:03.0'")
        assert page.errors == []
"""

import asyncio
import base64
import contextlib
import itertools
import json
import shutil
import tempfile
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest
import websockets

from jacaros import Mas, run
from jacaros.look import view
from jacaros.look.page.page import write_replay
from jacaros.look.records.recording import Recording
from played import played

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
PATIENCE = 30.0
"""Seconds after which a browser that does not answer fails the test."""

_KEYS = {
    " ": ("Space", 32),
    "Enter": ("Enter", 13),
    "Tab": ("Tab", 9),
    "Escape": ("Escape", 27),
    "ArrowLeft": ("ArrowLeft", 37),
    "ArrowUp": ("ArrowUp", 38),
    "ArrowRight": ("ArrowRight", 39),
    "ArrowDown": ("ArrowDown", 40),
    "Home": ("Home", 36),
    "End": ("End", 35),
}
_TEXTS = {"Enter": "\r", " ": " "}


def needs_chromium(test: Any) -> Any:
    """Mark a test that runs a browser."""
    test = pytest.mark.skipif(CHROMIUM is None, reason="Chromium is not installed")(test)
    return pytest.mark.browser(pytest.mark.slow(test))


class Page:
    """A page in the browser.

    Attributes:
        errors: uncaught exceptions, errors on its console, and requests that failed, in words.
        mas: the system whose page this is, in `browsed`.
    """

    mas: Mas

    def __init__(self, socket: Any, session: str) -> None:
        self.errors: list[str] = []
        self._socket, self._session = socket, session
        self._numbers = itertools.count(1)
        self._replies: dict[int, asyncio.Future[Any]] = {}
        self._loaded = asyncio.Event()
        self._reader = asyncio.get_running_loop().create_task(self._read())

    async def _read(self) -> None:
        async for text in self._socket:
            message = json.loads(text)
            if "id" in message:
                reply = self._replies.pop(message["id"], None)
                if reply is not None and not reply.done():
                    reply.set_result(message)
            else:
                self._take(message["method"], message["params"])

    def _take(self, method: str, params: Any) -> None:
        if method == "Page.loadEventFired":
            self._loaded.set()
        elif method == "Runtime.exceptionThrown":
            details = params["exceptionDetails"]
            self.errors.append(details.get("exception", {}).get("description") or details["text"])
        elif method == "Runtime.consoleAPICalled" and params["type"] in ("error", "assert"):
            self.errors.append(
                " ".join(str(each.get("value", each.get("description"))) for each in params["args"])
            )
        elif method == "Log.entryAdded" and params["entry"]["level"] == "error":
            self.errors.append(f"{params['entry']['text']} {params['entry'].get('url', '')}")

    async def call(self, method: str, **params: Any) -> Any:
        """Call a method of the protocol and return its result."""
        number = next(self._numbers)
        reply = self._replies[number] = asyncio.get_running_loop().create_future()
        message = {"id": number, "method": method, "params": params, "sessionId": self._session}
        await self._socket.send(json.dumps(message))
        answer = await asyncio.wait_for(reply, PATIENCE)
        assert "error" not in answer, f"{method}: {answer['error']}"
        return answer["result"]

    async def begin(self) -> None:
        """Have the browser report what happens on the page."""
        for domain in ("Page", "Runtime", "Log"):
            await self.call(f"{domain}.enable")
        await self.call("Emulation.setFocusEmulationEnabled", enabled=True)

    async def open(self, address: str | Path) -> None:
        """Open an address, or a file, and wait until it is loaded."""
        self._loaded.clear()
        await self.call("Page.navigate", url=address.as_uri() if isinstance(address, Path) else address)
        await asyncio.wait_for(self._loaded.wait(), PATIENCE)

    async def reload(self) -> None:
        """Load the page again, and wait until it is loaded: an expression in between would lose its page."""
        self._loaded.clear()
        await self.call("Page.reload")
        await asyncio.wait_for(self._loaded.wait(), PATIENCE)

    async def evaluate(self, expression: str) -> Any:
        """Return the value of an expression of JavaScript, a promise's when it has one."""
        answer = await self.call(
            "Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True
        )
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]
        return answer["result"].get("value")

    async def wait_for(self, condition: str, patience: float = PATIENCE) -> None:
        """Wait until an expression is true; fails after *patience* seconds."""
        end = asyncio.get_running_loop().time() + patience
        while not await self.evaluate(f"Boolean({condition})"):
            assert asyncio.get_running_loop().time() < end, f"not true within {patience} s: {condition}"
            await asyncio.sleep(0.02)

    async def text(self, selector: str) -> str:
        """Return the text of an element as displayed, "" without one."""
        return str(await self.evaluate(f"document.querySelector({json.dumps(selector)})?.innerText ?? ''"))

    async def texts(self, selector: str) -> list[str]:
        """Return the texts of all elements that are seen."""
        found = await self.evaluate(
            f"[...document.querySelectorAll({json.dumps(selector)})]"
            ".filter((each) => each.checkVisibility()).map((each) => each.innerText)"
        )
        return list(found)

    async def click(self, selector: str) -> None:
        """Click the middle of an element with the mouse."""
        await self.wait_for(f"document.querySelector({json.dumps(selector)})?.checkVisibility()")
        x, y = await self.evaluate(
            f"(() => {{ const element = document.querySelector({json.dumps(selector)});"
            "element.scrollIntoView({block: 'nearest', behavior: 'instant'});"
            "const box = element.getBoundingClientRect();"
            "return [box.x + box.width / 2, box.y + box.height / 2]; })()"
        )
        await self.click_at(x, y)

    async def click_at(self, x: float, y: float) -> None:
        """Click a point of the page with the mouse, in pixels."""
        await self.drag(x, y, x, y)

    async def drag(self, x: float, y: float, to_x: float, to_y: float) -> None:
        """Press the mouse at one point of the page and release it at another."""
        mouse = "Input.dispatchMouseEvent"
        await self.call(mouse, type="mouseMoved", x=x, y=y)
        await self.call(mouse, type="mousePressed", x=x, y=y, button="left", buttons=1, clickCount=1)
        if (to_x, to_y) != (x, y):
            for part in (0.5, 1.0):
                between = {"x": x + (to_x - x) * part, "y": y + (to_y - y) * part}
                await self.call(mouse, type="mouseMoved", button="left", buttons=1, **between)
        await self.call(mouse, type="mouseReleased", x=to_x, y=to_y, button="left", clickCount=1)

    async def press(self, key: str, shift: bool = False) -> None:
        """Press a key, such as ``Enter``, ``Tab``, ``ArrowLeft`` or ``a``."""
        code, number = _KEYS.get(key, (f"Key{key.upper()}", ord(key[0].upper())))
        text = _TEXTS.get(key, key if len(key) == 1 else "")
        common = {"key": key, "code": code, "windowsVirtualKeyCode": number, "modifiers": 8 if shift else 0}
        kind = "keyDown" if text else "rawKeyDown"
        await self.call("Input.dispatchKeyEvent", type=kind, **({"text": text} if text else {}), **common)
        await self.call("Input.dispatchKeyEvent", type="keyUp", **common)

    async def type(self, text: str) -> None:
        """Type a text into the field that has the focus."""
        await self.call("Input.insertText", text=text)

    async def resize(self, width: int, height: int, mobile: bool = False) -> None:
        """Give the page a size in pixels."""
        await self.call(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=mobile,
        )

    async def prefer(self, scheme: str) -> None:
        """Emulate a user who prefers the ``light`` or the ``dark`` scheme."""
        features = [{"name": "prefers-color-scheme", "value": scheme}]
        await self.call("Emulation.setEmulatedMedia", features=features)

    async def screenshot(self, clip: dict[str, float] | None = None) -> bytes:
        """Return what is seen, or a part of it, as PNG."""
        answer = await self.call("Page.captureScreenshot", format="png", **({"clip": clip} if clip else {}))
        return base64.b64decode(answer["data"])

    async def close(self) -> None:
        """Stop reading."""
        self._reader.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await self._reader


@asynccontextmanager
async def chromium(width: int = 1400, height: int = 900) -> AsyncIterator[Page]:
    """Start a browser of its own, with one page; both end with the ``async with``."""
    assert CHROMIUM is not None
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        process = await asyncio.create_subprocess_exec(
            CHROMIUM,
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--disable-dev-shm-usage",
            "--no-first-run",
            "--remote-debugging-port=0",
            f"--user-data-dir={profile}",
            f"--window-size={width},{height}",
            "about:blank",
            stdout=asyncio.subprocess.DEVNULL,
            stderr=asyncio.subprocess.PIPE,
        )
        try:
            address = await asyncio.wait_for(_address(process), PATIENCE)
            async with websockets.connect(address, max_size=None, proxy=None) as socket:
                page = Page(socket, await _attach(socket))
                try:
                    await page.begin()
                    await page.resize(width, height)
                    yield page
                finally:
                    await page.close()
        finally:
            await _end(process)


@asynccontextmanager
async def replayed(recording: Recording, at: float = 3.0, more: str = "") -> AsyncIterator[Page]:
    """Show the replay page of a recording at a moment, in seconds; it must not report an error."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "replay.html"
        write_replay(recording, file)
        async with chromium() as page:
            await page.open(f"{file.as_uri()}#t={at:g}{more}")
            await page.wait_for("!document.body.classList.contains('starting')")
            await page.wait_for(f"document.querySelector('#now')?.textContent === '0:{at:04.1f}'")
            yield page
            assert page.errors == []


@asynccontextmanager
async def browsed(program: str, seen: str, **options: Any) -> AsyncIterator[Page]:
    """Run an agent, ``bob``, and show its page once an element is seen; the page must not report an error."""
    async with Mas(seed=1, on_print=lambda *_: None, **options) as mas:
        mas.add_agent("bob", program)
        assert not options or mas.world is not None  # it comes into being when it is first asked for
        async with view(mas) as address, chromium() as page:
            page.mas = mas
            await page.open(address)
            await page.wait_for(f"document.querySelector('{seen}')?.checkVisibility()")
            yield page
            assert page.errors == []


def browsing(program: str, seen: str, **options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Make a test of a coroutine function that takes the page, see `browsed`; without Chromium it is skipped."""

    def play(scene: Callable[[Page], Awaitable[None]]) -> None:
        async def main() -> None:
            async with browsed(program, seen, **options) as page:
                await scene(page)

        run(main())

    return lambda scene: needs_chromium(played(play)(scene))


async def _end(process: asyncio.subprocess.Process) -> None:
    """Kill a browser, and read what it has written, so that its pipe closes with the loop still there."""
    with contextlib.suppress(ProcessLookupError):
        process.kill()
    await process.communicate()


async def _address(process: asyncio.subprocess.Process) -> str:
    assert process.stderr is not None
    async for line in process.stderr:
        found = line.decode(errors="replace").partition("DevTools listening on ")[2]
        if found:
            return found.strip()
    raise AssertionError("the browser ended before it could be driven")


async def _attach(socket: Any) -> str:
    """Attach to the first page of the browser and return the session."""

    async def ask(number: int, method: str, **params: Any) -> Any:
        await socket.send(json.dumps({"id": number, "method": method, "params": params}))
        while True:
            message = json.loads(await socket.recv())
            if message.get("id") == number:
                return message["result"]

    targets = (await ask(-1, "Target.getTargets"))["targetInfos"]
    page = next(each["targetId"] for each in targets if each["type"] == "page")
    return str((await ask(-2, "Target.attachToTarget", targetId=page, flatten=True))["sessionId"])
