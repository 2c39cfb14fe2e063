"""The guards of a run: find or start the one on this computer, and send the heartbeat to it and over the graph."""

import asyncio
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress

from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.guarded import guarded_by
from jacaros.robots.ros.heartbeat import GraphHeartbeat, Heartbeat, socket_path
from jacaros.robots.ros.open import GraphAddress
from jacaros.runtime.errors import UsageError

STARTING = 15.0
"""Seconds in which a guard must start and join the graph."""
RETRY = 0.05
"""Seconds between two attempts to connect."""


class RunGuard:
    """Keeps a guard beside a run, from its start to its end, and publishes a heartbeat for guards on other computers.

    A running guard for this node is reused: it may have been started separately, or have stopped the robot after an
    earlier run died. Otherwise one is started. It outlives the agents unless they shut down in order.

    Args:
        address: address of the graph.
        backend: the node of the run.
        simulated_time: whether the run follows ``/clock``.
        log: takes a line of the log.
    """

    def __init__(
        self, address: GraphAddress, backend: Backend, simulated_time: bool, log: Callable[[str], None]
    ) -> None:
        self._address, self._backend, self._simulated_time, self._log = address, backend, simulated_time, log
        self._path = socket_path(address.ros, address.identity, backend.node_name)
        self._heartbeat: Heartbeat | None = None
        self._graph_heartbeat: GraphHeartbeat | None = None
        self._returning: asyncio.Task[None] | None = None
        self._process: subprocess.Popen[bytes] | None = None

    async def start(self) -> None:
        """Find or start the guard, and wait until it can stop the robot.

        Raises:
            UsageError: the guard was not ready in time.
        """
        self._backend.add_exit_hook(self._leaving)
        self._graph_heartbeat = GraphHeartbeat(self._backend, self._simulated_time, self._log)
        try:
            async with asyncio.timeout(STARTING):
                await self._connect()
        except TimeoutError:
            raise UsageError(
                f"the guard did not start within {STARTING:g} s; run `jacaros guard` to see the reason"
            ) from None
        await self._graph_heartbeat.wait_for_answer()

    async def close(self) -> None:
        """Report to the guard that the robot has been stopped and the run has ended."""
        if self._returning is not None:
            self._returning.cancel()
        if self._graph_heartbeat is not None:
            self._graph_heartbeat.close()
        if self._heartbeat is not None:
            await self._heartbeat.close()

    async def _connect(self) -> None:
        while True:
            heartbeat = Heartbeat(guarded_by(self._backend), self._simulated_time, self._lost)
            with suppress(OSError):
                await heartbeat.connect(self._path)
                self._heartbeat = heartbeat
                await heartbeat.wait_until_ready()
                return
            with suppress(OSError):
                if self._process is None or self._process.poll() is not None:
                    self._launch()
            await asyncio.sleep(RETRY)

    def _leaving(self) -> None:
        if self._heartbeat is not None:
            self._heartbeat.leaving()
        if self._graph_heartbeat is not None:
            self._graph_heartbeat.goodbye()

    def _launch(self) -> None:
        name = self._backend.node_name.rpartition("/")[2]
        self._process = subprocess.Popen(
            [sys.executable, "-P", "-m", "jacaros", "guard", name, "--once", *self._address.arguments],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            start_new_session=True,  # Ctrl+C at the terminal ends the agents, which then stop the guard
        )

    def _lost(self) -> None:
        self._heartbeat = None
        self._log("warning: the guard died; restarting it, and until it is ready the robot is unguarded")
        self._returning = asyncio.ensure_future(self._connect())
