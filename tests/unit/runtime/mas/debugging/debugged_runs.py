"""Paused and unpaused runs on the virtual clock, and their records."""

from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import jacaros
from jacaros import Mas

EXAMPLES = Path(__file__).parents[5] / "examples"

Line = tuple[float, str, str]
"""When an agent printed what."""


class Observed:
    """What a run did.

    Attributes:
        lines: what agents printed, with the time.
        frames: the poses of the robots, with the time.
    """

    def __init__(self) -> None:
        self.lines: list[Line] = []
        self.frames: list[Any] = []


def observed(
    project: Path | None,
    seconds: float,
    during: Callable[[Mas, Observed], Awaitable[None]] | None = None,
    **options: Any,
) -> Observed:
    """Run a project for some seconds of virtual time, paused and continued by *during*."""
    found = Observed()

    def printed(agent: str, text: str) -> None:
        found.lines.append((mas.clock.elapsed, agent, text))

    def moved(frame: Any) -> None:
        if mas.exit_code is None:
            found.frames.append(frame)

    async def main() -> None:
        async with mas:
            world = mas.system.ros.world
            if world is not None:
                world.ground_truth.listen(moved)
            if during is not None:
                await during(mas, found)
            await mas.ended()

    mas = Mas(project, seed=1, on_print=printed, on_log=lambda *line: None, seconds=seconds, **options)
    jacaros.run(main(), clock="fast")
    return found


COUNTER = """\
count(0).
!go.
+!go : count(N) & N < 3
   <- .print(at, N);
      -+count(N + 1); .print(counted);
      .wait(100);
      !go.
@last
+!go
   <- .print(over).
"""


def debugged(
    test: Callable[[Mas], Awaitable[None]],
    program: str = COUNTER,
    lines: list[str] | None = None,
    **options: Any,
) -> list[str]:
    """Run *test* with an agent bob; what bob printed."""
    said = [] if lines is None else lines

    async def main() -> None:
        mas = Mas(seed=1, on_print=lambda agent, text: said.append(text), on_log=lambda *line: None)
        async with mas:
            mas.add_agent("bob", program, options=options)
            await test(mas)

    jacaros.run(main(), clock="fast")
    return said
