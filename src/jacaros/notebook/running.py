"""Run the programs of cells in a thread, so that their event loop and clock are their own, and print what they print."""

import asyncio
import sys
import threading
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from queue import Empty, SimpleQueue

from jacaros.artifacts.env.artifact import Artifact
from jacaros.look.page.recorder import record
from jacaros.notebook.run import Run
from jacaros.runtime.mas.embedding.mas import Mas, run
from jacaros.runtime.mas.embedding.waits import RunEnded
from jacaros.runtime.mas.mappings import MAIN
from jacaros.runtime.mas.options import RunOptions

GLANCE = 0.05
"""Seconds between two looks for output; an interruption waits as long."""


def run_programs(
    programs: Mapping[str, str], options: RunOptions, types: Sequence[type[Artifact]], file: Path
) -> Run:
    """Run programs to their end, printing their output in this thread; an interruption of it stops robots and run.

    Args:
        programs: texts of programs, by name of the agent.
        options: of the run, with its time limit.
        types: artifact types that agents can make.
        file: for the recording.

    Raises:
        JacarosError: a program or an option is wrong.
    """
    running = _Running(programs, options, types, file)
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
    return Run(file, running.tables, interrupted)


class _Running:
    """The run in its thread."""

    def __init__(
        self, programs: Mapping[str, str], options: RunOptions, types: Sequence[type[Artifact]], file: Path
    ) -> None:
        self._programs, self._options, self._types, self._file = programs, options, types, file
        self.output = SimpleQueue[tuple[str, bool]]()
        self.tables = ""
        self.error: BaseException | None = None
        self.stop: Callable[[], object] = lambda: None
        """Ends the run; may be called from another thread."""

    def run(self) -> None:
        try:
            run(self._main(), clock="fast" if self._options.fast else "real")
        except BaseException as error:  # raised again in the thread of the cell
            self.error = error

    async def _main(self) -> None:
        options = self._options
        mas = Mas(
            # The agents come later: an empty system is idle.
            options=replace(options, until_idle=False),
            name="notebook",
            on_print=lambda agent, text: self.output.put((f"[{agent}] {text}", False)),
            on_log=lambda text, _: self.output.put((text, True)),
        )
        async with mas:
            loop = asyncio.get_running_loop()
            self.stop = lambda: loop.call_soon_threadsafe(mas.stop)
            mas.add_artifact_types(*self._types)
            with record(mas, self._file), suppress(RunEnded):
                focus = _mapped(mas) if options.mappings and len(self._programs) == 1 else []
                for name, program in self._programs.items():
                    mas.add_agent(name, program, focus=focus)
                await _ended(mas, options)
                mas.stop()  # so that the recording has the end of the run
            self.tables = mas._repr_html_()


def _mapped(mas: Mas) -> list[str]:
    workspace = mas.environment.workspace(f"/{MAIN}")
    return [each.name for each in workspace.artifacts() if "#" in each.type_name]


async def _ended(mas: Mas, options: RunOptions) -> None:
    """Wait until the run ends: after its time at the latest."""
    await (mas.until_idle() if options.until_idle else mas.ended())
