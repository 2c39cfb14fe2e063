"""A program that a web page runs: its files come as text, its records and commands are messages."""

import asyncio
import json
import re
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from jacaros.browser.pumped_loop import PacedClock, PumpedLoop
from jacaros.look.page.live.delivery import Delivery, json_text
from jacaros.look.page.live.shown_run import ShownRun
from jacaros.look.page.watch import Watch, watch_of
from jacaros.runtime.clock import outside_run
from jacaros.runtime.errors import JacarosError, UsageError
from jacaros.runtime.mas.launch import load_deployment, mapped
from jacaros.runtime.mas.options import RunOptions
from jacaros.runtime.mas.system import System

Post = Callable[[str], object]
"""Takes a message for the page, as JSON."""

NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.-]{0,63}\.(asl|jcm|mas2j|yaml)")
"""Names of files. Python is not among them: a program that came in a link must not reach the browser."""
MOST_FILES, LARGEST = 20, 200_000
"""Maximum number of files, and of characters in all of them."""


@dataclass(frozen=True)
class Source:
    """The files of a program, and how to run them.

    Attributes:
        files: texts by name.
        main: the project or program to run, one of the files.
        world: one of the files, the name of a world of JaCaROS, or None for the project's own.
        mappings: mapping files, as `world`.
        seed: seed of all random numbers.
        until_idle: whether the run ends when no agent has anything to do.
    """

    files: Mapping[str, str]
    main: str
    world: str | None = None
    mappings: tuple[str, ...] = ()
    seed: int | None = None
    until_idle: bool = False

    def check(self) -> None:
        """Check names and sizes: the program may come from a link.

        Raises:
            UsageError: one is not allowed here.
        """
        for name in self.files:
            if not NAME.fullmatch(name):
                raise UsageError(f"file not allowed in a browser: `{name[:80]}`")
        if self.main not in self.files:
            raise UsageError(f"file not found: `{self.main[:80]}`")
        if len(self.files) > MOST_FILES or sum(map(len, self.files.values())) > LARGEST:
            raise UsageError(f"program too large: more than {MOST_FILES} files or {LARGEST} characters")

    def written(self, folder: Path) -> Path:
        """Write the files to a folder, and return the path of the one to run."""
        for name, text in self.files.items():
            (folder / name).write_text(text, encoding="utf-8", newline="\n")
        return folder / self.main

    def options(self, folder: Path) -> RunOptions:
        """Return the options of the run. Its agents touch no files, and create no Python objects."""
        local = {name: str(folder / name) for name in self.files}
        return RunOptions(
            fast=True,
            world=None if self.world is None else local.get(self.world, self.world),
            mappings=tuple(local.get(each, each) for each in self.mappings),
            seed=self.seed,
            until_idle=self.until_idle,
            restricted=True,
        )


class RunningProgram:
    """One run in a browser. The host calls `pump` as often as it asks for.

    Args:
        source: the program.
        post: takes the messages for the page: those of a live page, lines of the log (``{"kind": "log", …}``), and at the
            end ``{"kind": "over", "error": TEXT}``, where the text is empty unless the program could not run.
        speed: seconds of the run's clock per second of real time.
    """

    def __init__(self, source: Source, post: Post, speed: float = 1.0) -> None:
        self._post = post
        self._folder = tempfile.TemporaryDirectory(prefix="program")
        self._clock = PacedClock(speed)
        self._loop = PumpedLoop(self._clock)
        self._system: System | None = None
        self._watch: Watch | None = None
        self._shown: ShownRun | None = None
        self._delivery: Delivery | None = None
        self._replies: set[asyncio.Task[None]] = set()
        self._ended = False
        self._main = self._loop.create_task(self._run(source))

    @property
    def over(self) -> bool:
        """Whether the run has ended and everything has been posted."""
        return self._ended

    @property
    def elapsed(self) -> float:
        """Seconds of the run's clock since its start."""
        return self._clock.elapsed

    def pump(self, seconds: float) -> float | None:
        """Run for about *seconds*, and post what there is for the page. See `PumpedLoop.pump`."""
        if self._ended:
            return None
        rest = self._loop.pump(seconds)
        self._deliver()
        if not self._main.done():
            return rest
        self._ended = True
        for task in asyncio.all_tasks(self._loop):
            task.cancel()
        self._loop.pump(0.0)
        self._loop.close()
        self._folder.cleanup()
        self._post(json_text({"kind": "over", "error": self._main.result()}))
        return None

    def receive(self, command: str) -> None:
        """Execute a command of the page."""
        if self._ended or self._delivery is None:
            return
        task = self._loop.create_task(self._answer(self._delivery, json.loads(command)))
        self._replies.add(task)
        task.add_done_callback(self._replies.discard)

    def stop(self) -> None:
        """End the run in order."""
        if self._system is not None:
            self._system.stop_system(0.0, 0)

    # ---- the page

    def print(self, agent: str, text: str) -> None:
        """Show a line of an agent's output."""
        if self._watch is not None:
            self._watch.text(agent, text)

    def log(self, text: str, level: str = "info") -> None:
        """Post a line of the log."""
        self._post(json_text({"kind": "log", "level": level, "text": text}))

    def _deliver(self) -> None:
        while self._delivery is not None and (message := self._delivery.take()) is not None:
            self._post(message)

    async def _answer(self, delivery: Delivery, command: Mapping[str, Any]) -> None:
        assert self._shown is not None
        self._post(json_text(await self._shown.watcher.answer(delivery, command)))

    # ---- the run

    async def _run(self, source: Source) -> str:
        """Run the program to its end, and return why it could not."""
        folder = Path(self._folder.name)
        try:
            source.check()
            options = source.options(folder)
            deployment = mapped(load_deployment(source.written(folder)), options.mappings)
            self._system = System(deployment, self._clock, self, options)
            await self._system.run(self._begin)
        except JacarosError as error:
            return str(error).replace(f"{folder}/", "")
        finally:
            if self._watch is not None:
                self._watch.stop()
            if self._shown is not None:
                self._shown.end()
        return ""

    def _begin(self) -> None:
        """Show the run that has just been created."""
        assert self._system is not None
        with outside_run():
            self._shown = ShownRun(self._system)
            self._watch = watch_of(self._system, [self._shown.watcher], live=True)
            self._watch.start()
            self._shown.begin(self._watch)
            self._delivery = self._shown.watcher.begin()
