"""Draw the pictures of the documentation from runs of the examples, with the project's own recorder and page."""

import asyncio
import os
import re
import sys
import tempfile
from pathlib import Path

from jacaros.look import Recording, write_picture
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


def main() -> None:
    """Draw them all."""
    IMAGES.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        for name, (project, seconds, width) in PICTURES.items():
            record = str(Path(scratch) / "run.jsonl")
            limit = [] if seconds is None else ["--for", str(seconds)]
            arguments = [
                "run",
                str(ROOT / project),
                "--clock",
                "fast",
                "--seed",
                "1",
                "--record",
                record,
                *limit,
            ]
            if call(arguments) != 0:
                raise SystemExit(f"{project} did not end well")
            write_picture(Recording.read(record), IMAGES / name, width)
    asyncio.run(take_live_page(*LIVE_PAGE))


async def take_live_page(name: str, project: str, seconds: float) -> None:
    """Take a picture of the live page of a run, with the browser used by the tests."""
    sys.path.append(str(ROOT / "tests" / "unit" / "look"))
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
