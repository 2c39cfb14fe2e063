"""``jacaros run PROJECT --all-nodes``: every node of a project in its own process on this computer."""

import asyncio
import os
import signal
import sys
from asyncio import StreamReader
from asyncio.subprocess import DEVNULL, PIPE, Process
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from types import FrameType
from typing import Final, TextIO

from jacaros.robots.ros import lifetime
from jacaros.runtime.cli.outputs import OUTPUT_GONE, RequestedOutputs
from jacaros.runtime.cli.usage import listed, usage_error

_CHUNK: Final = 1 << 16
_IS_POSIX: Final = os.name == "posix"


class Nodes:
    """The processes of the nodes. They go on when one of them ends, and end with this process.

    Args:
        names: names of the nodes.
        arguments: returns the arguments of ``jacaros run`` for a node.
    """

    def __init__(self, names: Sequence[str], arguments: Callable[[str], Sequence[str]]) -> None:
        self._names, self._arguments = names, arguments
        self._running: dict[str, Process] = {}
        self._exit_code = 0
        self._loop: asyncio.AbstractEventLoop | None = None
        self._is_ending = False

    def run(self) -> int:
        """Run all nodes until each has ended. Return the exit code of the first one that failed; 0 if none did."""
        with lifetime.serving(self._notice):
            try:
                asyncio.run(self._run())
            except BrokenPipeError:
                return OUTPUT_GONE
        return self._exit_code

    async def _run(self) -> None:
        self._loop = asyncio.get_running_loop()
        try:
            for name in self._names:
                self._running[name] = await _start(self._arguments(name))
            await asyncio.gather(*(self._follow(*each) for each in self._running.items()))
        finally:
            self._send(signal.SIGTERM)
            await asyncio.gather(*(process.wait() for process in self._running.values()))

    async def _follow(self, name: str, process: Process) -> None:
        """Print the output of a node until it ends."""
        assert process.stdout is not None
        assert process.stderr is not None
        await asyncio.gather(
            _print(process.stdout, name, sys.stdout), _print(process.stderr, name, sys.stderr)
        )
        code = await process.wait()
        del self._running[name]
        if code:
            self._exit_code = self._exit_code or (code if code > 0 else 128 - code)
            self._report(name, code)

    def _report(self, name: str, code: int) -> None:
        """Log that a node failed, unless a signal ends all of them."""
        if self._is_ending:
            return
        what = f"ended with exit code {code}" if code > 0 else f"was killed by signal {-code}"
        rest = f"; still running: {listed(f'`{each}`' for each in self._running)}" if self._running else ""
        print(f"warning: node `{name}` {what}{rest}", file=sys.stderr, flush=True)

    def _notice(self, number: int, frame: FrameType | None) -> None:
        """Pass a signal on to the nodes."""
        if self._loop is None:
            raise KeyboardInterrupt
        self._loop.call_soon_threadsafe(self._send, number)

    def _send(self, number: int) -> None:
        self._is_ending = True
        for process in self._running.values():
            with suppress(ProcessLookupError):
                if _IS_POSIX:
                    process.send_signal(number)
                elif number == signal.SIGTERM:  # on Windows, Ctrl+C reaches all processes of a console
                    process.terminate()


async def _start(arguments: Sequence[str]) -> Process:
    return await asyncio.create_subprocess_exec(
        *(sys.executable, "-P", "-m", "jacaros", "run", *arguments),
        stdin=DEVNULL,
        stdout=PIPE,
        stderr=PIPE,
        env={**os.environ, "PYTHONIOENCODING": "utf-8"},
        start_new_session=_IS_POSIX,  # otherwise Ctrl+C at the terminal reaches the nodes twice
    )


async def _print(output: StreamReader, name: str, stream: TextIO) -> None:
    """Print the lines of a node's output, each with the name of the node."""
    rest = b""
    while chunk := await output.read(_CHUNK):
        *lines, rest = (rest + chunk).split(b"\n")
        for line in lines:
            print(f"[{name}] {line.decode(errors='replace')}", file=stream)
        stream.flush()
    if rest:
        print(f"[{name}] {rest.decode(errors='replace')}", file=stream, flush=True)


def arguments_of_nodes(
    given: Sequence[str], outputs: RequestedOutputs, keys: Path | None = None
) -> Callable[[str], Sequence[str]]:
    """Return the function from a node to its arguments: those *given* to all, with output files and keys of its own.

    Args:
        given: the arguments of the command.
        outputs: the requested outputs.
        keys: folder with a folder of keys for each node.

    Raises:
        UsageError: an output can be had only once.
    """
    if outputs.view == "terminal" or outputs.view_port:
        option = "--view=terminal" if outputs.view == "terminal" else f"--view-port {outputs.view_port}"
        raise usage_error(f"{option} excludes --all-nodes", "--view opens one page for each node")
    common = [each for each in given if each != "--all-nodes"]

    def arguments(node: str) -> Sequence[str]:
        own_keys = [] if keys is None else ["--fleet-keys", str(keys / node)]
        return [*common, "--node", node, *_files(outputs, node), *own_keys]

    return arguments


def _files(outputs: RequestedOutputs, node: str) -> Iterator[str]:
    """Yield the options of a node's own output files; the last value of an option counts."""
    files: dict[str, Path | None] = {
        "--record": outputs.record,
        "--replay": outputs.replay,
        "--ground-truth": outputs.ground_truth,
    }
    for option, file in files.items():
        if file is not None:
            yield from (option, str(file.with_name(f"{node}.{file.name}")))
