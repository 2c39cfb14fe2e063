"""What the JavaScript of a page calls."""

import json

from jacaros.browser.program import Post, RunningProgram, Source


def start(source: str, post: Post, speed: float = 1.0) -> RunningProgram:
    """Start a program.

    Args:
        source: the fields of a `Source`, as JSON.
        post: takes messages for the page.
        speed: seconds of the run's clock per second of real time.
    """
    given = json.loads(source)
    given["mappings"] = tuple(given.get("mappings", ()))
    return RunningProgram(Source(**given), post, speed)
