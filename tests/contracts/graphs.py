"""Graphs in which contract tests run their peers: in this process, or real ones with processes."""

import asyncio
import contextlib
import json
import os
import queue
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from typing import IO, Any, cast

import peer as peer_module

import jacaros.robots.ros.errors
from jacaros.robots.ros.drivers.memory.graph import MemoryGraph
from jacaros.runtime.clock import VirtualClock, new_event_loop

PATIENCE = 90.0
"""Seconds after which a test gives up; far more than any step takes on a busy machine."""


MODULES = {"mqtt": "mqtt_driver.backend:MqttBackend"}
"""Kinds of graph whose driver is not a part of the package, by the name of its module."""


class MemoryPeer:
    """A peer in this process: commands run the graph's loop until they are done."""

    def __init__(self, graph: "InMemory", name: str, namespace: str, options: dict[str, Any]) -> None:
        self._graph = graph
        self._peer = peer_module.Peer("memory", graph.clock, name, namespace, graph=graph.shared, **options)

    def __getattr__(self, command: str) -> Callable[..., Any]:
        async def run(*args: Any, **kwargs: Any) -> Any:
            result = getattr(self._peer, command)(*args, **kwargs)
            return await result if asyncio.iscoroutine(result) else result

        return lambda *args, **kwargs: self._graph.loop.run_until_complete(run(*args, **kwargs))


class InMemory:
    """The graph inside this process, on a virtual clock."""

    kind = "memory"
    separate_processes = False

    def __init__(self) -> None:
        self.clock = VirtualClock()
        self.loop = new_event_loop(self.clock)
        self.shared = MemoryGraph()
        self._peers: list[MemoryPeer] = []

    def peer(self, name: str, namespace: str = "", start: bool = True, **options: Any) -> Any:
        made = MemoryPeer(self, name, namespace, options)
        self._peers.append(made)
        if start:
            made.start()
        return made

    def node_of(self, made: Any) -> str:
        """The node as which others see a peer."""
        return str(made.node_name())

    def kill(self, made: Any) -> None:
        """End a peer without a word to the others."""
        self.shared.vanish(made.node_name())

    def wait_until(self, condition: Callable[[], object], what: str, patience: float = PATIENCE) -> None:
        for _ in range(1000):
            if condition():
                return
            self.loop.run_until_complete(self.clock.sleep(0.01))
        raise AssertionError(f"not within 10 s of the virtual clock: {what}")

    def pass_time(self, seconds: float) -> None:
        self.loop.run_until_complete(self.clock.sleep(seconds))

    def close(self) -> None:
        for made in self._peers:
            made.close()
        self.loop.run_until_complete(self.loop.shutdown_asyncgens())
        self.loop.close()


class ProcessPeer:
    """A peer in a process of its own."""

    def __init__(
        self, kind: str, name: str, namespace: str, options: dict[str, Any], environment: dict[str, str]
    ) -> None:
        flags = ["-X", "faulthandler", *environment.pop("PYTHON_FLAGS", "").split()]
        program = [sys.executable, *flags, peer_module.__file__]
        self._process = subprocess.Popen(
            [*program, kind, name, *([namespace] if namespace else [])],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env=os.environ | environment | {"PEER_OPTIONS": json.dumps(options)},
        )
        streams = (self._process.stdin, self._process.stdout, self._process.stderr)
        self._stdin, self._stdout, self._stderr = cast("tuple[IO[str], IO[str], IO[str]]", streams)
        self._replies: queue.Queue[dict[str, Any] | None] = queue.Queue()
        self.stray_output: list[str] = []
        self.errors: list[str] = []
        self._readers = [threading.Thread(target=t, daemon=True) for t in (self._read, self._read_errors)]
        for reader in self._readers:
            reader.start()
        self._number = 0

    def __getattr__(self, command: str) -> Callable[..., Any]:
        if command.startswith("_"):
            raise AttributeError(command)
        return lambda *args, **kwargs: self._do(command, args, kwargs)

    def signal(self, number: signal.Signals) -> None:
        self._process.send_signal(number)

    def wait(self) -> int:
        """Wait for the process's end and give its exit code."""
        code = self._process.wait(PATIENCE)
        for reader in self._readers:
            reader.join(PATIENCE)
        return code

    def is_over(self) -> bool:
        return self._process.poll() is not None

    def dispose(self) -> None:
        """Have the peer leave the graph and end; kill it when it does not, and say what it said."""
        problem: BaseException | None = None
        if not self.is_over():
            try:
                self._do("close", (), {})
                self._stdin.close()
                self.wait()
            except (AssertionError, OSError, subprocess.TimeoutExpired) as caught:
                problem = caught
                self._process.send_signal(signal.SIGABRT)  # faulthandler shows where it hangs
        self.wait()
        for stream in (self._stdin, self._stdout, self._stderr):
            with contextlib.suppress(BrokenPipeError):
                stream.close()
        assert problem is None, f"the peer does not end: {problem}\n" + "".join(self.errors)

    def _do(self, command: str, args: tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
        self._number += 1
        line = json.dumps({"id": self._number, "do": command, "args": args, "kwargs": kwargs})
        self._stdin.write(line + "\n")
        self._stdin.flush()
        deadline = time.monotonic() + PATIENCE
        while True:
            try:
                answer = self._replies.get(timeout=max(0.0, deadline - time.monotonic()))
            except queue.Empty:
                answer = None
            assert answer is not None, f"no answer to {command}; the peer said:\n" + "".join(self.errors)
            if answer["id"] == self._number:
                break
        if "error" in answer:
            known = getattr(jacaros.robots.ros.errors, answer["error"], None)
            problem = (known or AssertionError)(answer["text"] if known else f"{answer}")
            if answer["reason"] is not None:
                problem.reason = answer["reason"]
            raise problem
        return answer["result"]

    def _read(self) -> None:
        for line in self._stdout:
            if line.startswith("@"):
                self._replies.put(json.loads(line[1:]))
            else:
                self.stray_output.append(line)
        self._replies.put(None)

    def _read_errors(self) -> None:
        self.errors.extend(self._stderr)


class InProcesses:
    """A real ROS graph with a process for each node."""

    separate_processes = True

    def __init__(self, kind: str, environment: dict[str, str]) -> None:
        self.kind = kind
        self.environment = environment
        self._peers: list[ProcessPeer] = []

    def peer(
        self, name: str, namespace: str = "", start: bool = True, flags: str = "", **options: Any
    ) -> Any:
        environment = self.environment | ({"PYTHON_FLAGS": flags} if flags else {})
        made = ProcessPeer(MODULES.get(self.kind, self.kind), name, namespace, options, dict(environment))
        self._peers.append(made)
        if start:
            made.start()
        return made

    def node_of(self, made: Any) -> str:
        """The node as which others see a peer."""
        return str(made.node_name())

    def kill(self, made: ProcessPeer) -> None:
        """End a peer without a word to the others."""
        made.signal(signal.SIGKILL)
        made.wait()

    def wait_until(self, condition: Callable[[], object], what: str, patience: float = PATIENCE) -> None:
        deadline = time.monotonic() + patience
        while not condition():
            assert time.monotonic() < deadline, f"not within {patience} s: {what}"
            time.sleep(0.01)

    def pass_time(self, seconds: float) -> None:
        """Give a thing that must not happen the time to happen."""
        time.sleep(seconds)

    def dispose(self, made: ProcessPeer) -> None:
        self._peers.remove(made)
        made.dispose()
        assert made.stray_output == [], f"standard output belongs to the agents: {made.stray_output}"

    def close(self) -> None:
        problems = []
        for made in list(self._peers):
            try:
                self.dispose(made)
            except AssertionError as problem:
                problems.append(str(problem))
        assert not problems, "\n".join(problems)
