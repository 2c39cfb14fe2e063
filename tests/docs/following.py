"""Follow a page as its reader does: write its files, make its changes, run its commands, press Ctrl+C.

Each command is run in a real shell; what earlier commands exported is there. What stands behind ``console``::

    ```console               for every reader
    ```console ros2 memory   only for readers with these graphs
    ```console ros2 terminal in another terminal: it goes on while the rest of the page is followed

A line ``^C`` in an output is Ctrl-C, pressed when the lines above it have come. Lines that begin with ``[ros]`` tell of
waiting; on a real graph they come or do not, and are left out.
"""

import contextlib
import os
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from types import TracebackType
from typing import Any

from pages import Block, blocks, is_file

PATIENCE = 150.0
"""Time limit in seconds for expected output; slow output is not an error."""

MEMORY = "memory"
KINDS = (MEMORY, "ros1", "ros2")
TERMINAL = "terminal"
CTRL_C = "^C\n"


def commands(text: str) -> list[tuple[str, str]]:
    """Return the commands of a console block, each with its expected output."""
    parts = re.split(r"^\$ ", text, flags=re.MULTILINE)
    assert not parts[0].strip(), "a console block begins with a command"
    found = []
    for part in parts[1:]:
        command, _, output = re.sub(r"\\\n\s*(?:> )?", "", part).partition("\n")
        found.append((command, output))
    return found


def pattern(expected: str) -> str:
    """A regular expression for an expected output: lines `...` stand for any lines, `...` within for any text."""
    lines = []
    for line in expected.rstrip("\n").splitlines():
        if line.strip() == "...":
            lines.append(r"(?:[^\n]*\n)*?")
        else:
            lines.append(re.escape(line.rstrip()).replace(re.escape("..."), "[^\\n]*") + r"[ ]*\n")
    return "".join(lines)


class Command:
    """A command in a separate shell and process group, as in a terminal; its output is read continuously.

    Args:
        command: for the shell.
        folder: where it runs.
        environment: all of its variables.
        quiet: leave out lines that tell of waiting.
    """

    def __init__(self, command: str, folder: Path, environment: Mapping[str, str], quiet: bool) -> None:
        self._quiet = quiet
        self._text = ""
        self._process = subprocess.Popen(
            ["sh", "-c", command],
            cwd=folder,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        assert self._process.stdout is not None
        for line in self._process.stdout:
            self._text += line

    @property
    def output(self) -> str:
        """Return the output so far, including errors."""
        if not self._quiet:
            return self._text
        return "".join(line for line in self._text.splitlines(keepends=True) if not line.startswith("[ros]"))

    def until(self, condition: Callable[[], object]) -> None:
        """Wait for a condition, or the end of the command, as long as patience lasts."""
        deadline = time.monotonic() + PATIENCE
        while not condition() and self._process.poll() is None and time.monotonic() < deadline:
            time.sleep(0.05)

    def prints(self, expected: str) -> bool:
        """Return whether lines like these appear."""
        found = re.compile(pattern(expected))
        self.until(lambda: found.match(self.output))
        return bool(found.match(self.output))

    def press_ctrl_c(self) -> None:
        """Send what a terminal would send."""
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self._process.pid, signal.SIGINT)

    def end(self) -> str:
        """Wait for the end; return the whole output."""
        self.until(lambda: False)
        if self._process.poll() is None:
            os.killpg(self._process.pid, signal.SIGKILL)
            self._text += f"(still running after {PATIENCE:g} s)\n"
        self._reader.join()
        self._process.wait()
        assert self._process.stdout is not None
        self._process.stdout.close()
        return self.output


class Reader:
    """A user who follows a page in a folder; a context manager that closes the terminals at the end.

    Args:
        folder: where the reader is.
        kind: the graph that the reader has: ``memory``, ``ros1`` or ``ros2``.
        environment: variables in all terminals.
    """

    def __init__(
        self, folder: Path, kind: str = MEMORY, environment: Mapping[str, str] | None = None
    ) -> None:
        self._folder = folder
        self._kind = kind
        path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
        ours = {"PATH": path, "COLUMNS": "100", "NO_COLOR": "1", "PYTHONUNBUFFERED": "1"}
        if kind == MEMORY:
            ours["JACAROS_CLOCK"] = "fast"  # nothing would be different in real time, but later
            ours["XDG_RUNTIME_DIR"] = str(folder)  # the only running system is the page's
        self._environment = {**os.environ, **ours, **(environment or {})}
        self._exports = ""
        self._terminals: list[Command] = []
        self._deaf: Any = None

    def follow(self, page: Path) -> None:
        """Do everything that a page says, and compare the output with what it shows."""
        for block in blocks(page):
            where = f"{page.name}:{block.line}"
            if block.language == "console":
                self._console(block, where)
            elif block.language == "diff":
                self._change(block, where)
            elif is_file(block):
                file = self._folder / block.purpose
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(block.text, encoding="utf-8")

    def _console(self, block: Block, where: str) -> None:
        words = block.purpose.split()
        assert set(words) <= {*KINDS, TERMINAL}, f"{where}: {block.purpose}"
        kinds = [word for word in words if word in KINDS]
        if kinds and self._kind not in kinds:
            return
        for command, expected in commands(block.text):
            if TERMINAL in words:
                self._in_terminal(command, expected, where)
            else:
                self._here(command, expected, where)

    def _start(self, command: str) -> Command:
        text = f"{self._exports}{command}"
        return Command(text, self._folder, self._environment, quiet=self._kind != MEMORY)

    def _here(self, command: str, expected: str, where: str) -> None:
        before, pressed, after = expected.partition(CTRL_C)
        running = self._start(command)
        if pressed:
            came = running.prints(before)
            running.press_ctrl_c()
            output = running.end()
            assert came, f"{where}: $ {command}\nprints\n{output}\nand not, before Ctrl-C,\n{before}"
        else:
            output = running.end()
        # While the key is pressed, agents may print further lines, but nothing else does.
        meanwhile = r"(?:\[[^\n]*\n)*" if pressed else ""
        found = re.fullmatch(pattern(before) + meanwhile + pattern(after), output)
        assert found, f"{where}: $ {command}\nprints\n{output}\nand not\n{expected}"
        if command.startswith("export "):
            self._exports += f"{command}\n"

    def _in_terminal(self, command: str, expected: str, where: str) -> None:
        running = self._start(command)
        self._terminals.append(running)
        assert running.prints(expected), (
            f"{where}: $ {command}\nprints\n{running.output}\nand not\n{expected}"
        )

    def _change(self, block: Block, where: str) -> None:
        """Change a file by a diff, whose lines must appear in the file exactly once."""
        file = self._folder / block.purpose
        lines = block.text.splitlines(keepends=True)
        old = "".join(line[1:] for line in lines if line[0] in " -")
        new = "".join(line[1:] for line in lines if line[0] in " +")
        text = file.read_text(encoding="utf-8")
        assert text.count(old) == 1, (
            f"{where}: {file.name} does not have these lines, once:\n{old}\nbut\n{text}"
        )
        file.write_text(text.replace(old, new), encoding="utf-8")

    def __enter__(self) -> "Reader":
        # What a script starts in the background is deaf to Ctrl-C, and so would be all that it starts.
        self._deaf = signal.signal(signal.SIGINT, signal.default_int_handler)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for terminal in reversed(self._terminals):
            terminal.press_ctrl_c()
            terminal.end()
        signal.signal(signal.SIGINT, self._deaf)
