"""Draw the pictures of the documentation from runs of the examples, with the project's own recorder and page.

``tools/make_pictures.py page_failure.png page_time.png`` draws only these.
"""

import asyncio
import contextlib
import os
import re
import sys
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from jacaros.look import Recording, write_picture
from jacaros.look.page.page import write_replay
from jacaros.runtime.cli.main import call

ROOT = Path(__file__).resolve().parent.parent
IMAGES = ROOT / "docs" / "images"

PICTURES = {
    "patrol.svg": ("examples/04_patrol/patrol.jcm", 75.0, 460),
    "house_cleaning.svg": ("examples/05_house_cleaning/house_cleaning.jcm", None, 560),
}
"""Project, duration in seconds, and width in pixels of each picture."""

LIVE_PAGE = ("page.png", "examples/09_three_robots/three_robots.jcm", 30.0)
"""The picture of a live page: its name, the project, and the time in seconds at which it is taken."""


class Shot(NamedTuple):
    """A picture of a replay.

    Attributes:
        run: arguments of `jacaros run`, with the path of the program or project first.
        moment: seconds that are shown, or None for the moment at which the replay opens.
        size: of the window, in pixels.
        part: selector of the part of the page in the picture, or "" for the window.
    """

    run: tuple[str, ...]
    moment: float | None
    size: tuple[int, int]
    part: str = ""


EMPTY = (
    "watch.asl",
    "--world",
    "patrol",
    "--mapping",
    "nav2.yaml",
    "--mapping",
    "turtlebot4.yaml",
    "--for",
    "180",
)
REPLAYS = {
    "page_failure.png": Shot(EMPTY, None, (1280, 800)),
    "page_time.png": Shot(
        (str(ROOT / "examples/04_patrol/patrol.jcm"), "--for", "200"), 120.0, (1280, 1000), "#when"
    ),
    "page_phone.png": Shot(EMPTY, None, (390, 844)),
}
"""Pictures of replays; ``watch.asl`` is in ``docs/how-to/watch_a_run.md``."""


def main() -> None:
    """Draw those that the command line names, or all."""
    wanted = set(sys.argv[1:]) or {*PICTURES, *REPLAYS, LIVE_PAGE[0]}
    IMAGES.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        for name, (project, seconds, width) in PICTURES.items():
            if name in wanted:
                limit = [] if seconds is None else ["--for", str(seconds)]
                write_picture(recorded(Path(scratch), [str(ROOT / project), *limit]), IMAGES / name, width)
        for name in REPLAYS.keys() & wanted:
            write_replay(recorded_shot(Path(scratch), REPLAYS[name]), Path(scratch) / "replay.html")
            asyncio.run(take_replay(name, REPLAYS[name], Path(scratch) / "replay.html"))
    if LIVE_PAGE[0] in wanted:
        asyncio.run(take_live_page(*LIVE_PAGE))


def recorded(scratch: Path, arguments: Iterable[str]) -> Recording:
    """Run a program or project and return its recording."""
    record = str(scratch / "run.jsonl")
    with contextlib.chdir(scratch):  # messages name programs as you would start them
        status = call(["run", *arguments, "--clock", "fast", "--seed", "1", "--record", record])
    if status != 0:
        raise SystemExit(f"{arguments} did not end well")
    return Recording.read(record)


def recorded_shot(scratch: Path, shot: Shot) -> Recording:
    """Run the program or project of a picture, with the program of the documentation beside it."""
    page = (ROOT / "docs/how-to/watch_a_run.md").read_text(encoding="utf-8")
    (scratch / "watch.asl").write_text(page.partition("```agentspeak watch.asl\n")[2].partition("```")[0])
    return recorded(scratch, shot.run)


async def take_replay(name: str, shot: Shot, replay: Path) -> None:
    """Take a picture of a replay, with the browser used by the tests."""
    sys.path += [str(ROOT / "tests"), str(ROOT / "tests" / "unit" / "look")]
    from devtools import chromium

    moment = "" if shot.moment is None else f"t={shot.moment:g}"
    async with chromium(*shot.size) as page:
        await page.resize(*shot.size, mobile=shot.size[0] < 500)
        await page.open(f"{replay.as_uri()}#theme=light&{moment}")
        await page.wait_for("document.querySelector('#curves .value')?.checkVisibility()")
        await page.evaluate("new Promise((done) => setTimeout(done, 500))")  # panels are drawn every 0.1 s
        box = (
            await page.evaluate(
                f"(({{ x, y, width, height }}) => ({{ x, y, width, height, scale: 1 }}))"
                f"(document.querySelector('{shot.part}').getBoundingClientRect())"
            )
            if shot.part
            else None
        )
        (IMAGES / name).write_bytes(await page.screenshot(box))


async def take_live_page(name: str, project: str, seconds: float) -> None:
    """Take a picture of the live page of a run, with the browser used by the tests."""
    sys.path += [str(ROOT / "tests"), str(ROOT / "tests" / "unit" / "look")]
    from devtools import chromium

    jacaros = Path(sys.executable).parent / "jacaros"
    run = await asyncio.create_subprocess_exec(
        jacaros,
        *("run", ROOT / project, "--seed", "1", "--view"),
        stdout=asyncio.subprocess.DEVNULL,
        stderr=asyncio.subprocess.PIPE,
        env={**os.environ, "BROWSER": "true"},  # a command that opens no browser
    )
    try:
        assert run.stderr is not None
        while (found := re.search(rb"http\S+", await run.stderr.readline())) is None:
            pass
        async with chromium(1280, 800) as page:
            await page.open(found[0].decode())
            await page.wait_for(f"document.querySelector('#scrub').max >= {seconds}", patience=10 * seconds)
            (IMAGES / name).write_bytes(await page.screenshot())
    finally:
        run.terminate()
        await run.communicate()


if __name__ == "__main__":
    main()
