"""Run the programs of cells in a thread, so that their event loop and clock are their own, and print what they print."""

import asyncio
import sys
import threading
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import Literal, NamedTuple

from jacaros.artifacts.env.artifact import Artifact
from jacaros.look.page.recorder import record
from jacaros.notebook.run import Run
from jacaros.runtime.mas.embedding.mas import Mas, run
from jacaros.runtime.mas.embedding.waits import RunEnded
from jacaros.runtime.mas.mappings import MAIN

GLANCE = 0.05
"""Seconds between two looks for output; an interruption waits as long."""


class Settings(NamedTuple):
    """How programs run; as the options of ``jacaros run``.

    Attributes:
        world: world file or name; None for the world ``empty``.
        mappings: mapping files of the robot.
        faults: fault file of the world.
        seed: of the run.
        seconds: after which the run ends.
        clock: ``fast`` or ``real``.
        until_idle: whether the run ends when no agent has anything to do.
    """

    world: str | None = None
    mappings: Sequence[str] = ()
    faults: str | None = None
    seed: int = 0
    seconds: float = 60.0
    clock: Literal["fast", "real"] = "fast"
    until_idle: bool = False


def run_programs(
    programs: Mapping[str, str], settings: Settings, types: Sequence[type[Artifact]], file: Path
) -> Run:
    """Run programs to their end, printing their output in this thread; an interruption of it stops robots and run.

    Args:
        programs: texts of programs, by name of the agent.
        settings: of the run.
        types: artifact types that agents can make.
        file: for the recording.

    Raises:
        JacarosError: a program or an option is wrong.
    """
    running = _Running(programs, settings, types, file)
    thread = threading.Thread(target=running.run, name="jacaros", daemon=True)
    thread.start()
    interrupted = False
    while thread.is_alive() or not running.output.empty():
        try:
            line, is_log = running.output.get(timeout=GLANCE)
            print(line, file=sys.stderr if is_log else sys.stdout)
        except Empty:
            continue
        except KeyboardInterrupt:
            interrupted = True
            running.stop()
    if running.error is not None:
        raise running.error
    return Run(file, running.tables, settings.seconds, interrupted)


class _Running:
    """The run in its thread."""

    def __init__(
        self, programs: Mapping[str, str], settings: Settings, types: Sequence[type[Artifact]], file: Path
    ) -> None:
        self._programs, self._settings, self._types, self._file = programs, settings, types, file
        self.output = SimpleQueue[tuple[str, bool]]()
        self.tables = ""
        self.error: BaseException | None = None
        self._stop: Callable[[], object] = lambda: None

    def stop(self) -> None:
        """End the run; may be called from another thread."""
        self._stop()

    def run(self) -> None:
        try:
            run(self._main(), clock=self._settings.clock)
        except BaseException as error:  # raised again in the thread of the cell
            self.error = error

    async def _main(self) -> None:
        given = self._settings
        mas = Mas(
            name="notebook",
            on_print=lambda agent, text: self.output.put((f"[{agent}] {text}", False)),
            on_log=lambda text, _: self.output.put((text, True)),
            world=given.world,
            mappings=tuple(given.mappings),
            faults=given.faults,
            seed=given.seed,
        )
        async with mas:
            self._stop = partial(asyncio.get_running_loop().call_soon_threadsafe, mas.stop)
            mas.add_artifact_types(*self._types)
            with record(mas, self._file), suppress(RunEnded):
                focus = _mapped(mas) if given.mappings and len(self._programs) == 1 else []
                for name, program in self._programs.items():
                    mas.add_agent(name, program, focus=focus)
                await _ended(mas, given)
                mas.stop()  # so that the recording has the end of the run
            self.tables = mas._repr_html_()


def _mapped(mas: Mas) -> list[str]:
    workspace = mas.environment.workspace(f"/{MAIN}")
    return [each.name for each in workspace.artifacts() if "#" in each.type_name]


async def _ended(mas: Mas, settings: Settings) -> None:
    """Wait until the run ends."""
    ways = {asyncio.ensure_future(mas.ended()), asyncio.ensure_future(mas.sleep(settings.seconds))}
    if settings.until_idle:
        ways.add(asyncio.ensure_future(mas.until_idle()))
    done, others = await asyncio.wait(ways, return_when=asyncio.FIRST_COMPLETED)
    for each in others:
        each.cancel()
    for each in done:
        each.result()
