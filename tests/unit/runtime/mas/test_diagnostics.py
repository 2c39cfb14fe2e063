"""The state of a run on /diagnostics."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from jacaros.agents.mind.mind import Mind
from jacaros.robots.ros.open import open_backend
from jacaros.runtime.clock import VirtualClock, run
from jacaros.runtime.mas.console import RunConsole
from jacaros.runtime.mas.diagnostics import OK, TOPIC, TYPE, WARN, AgentHealth
from jacaros.runtime.mas.launch import load_deployment
from jacaros.runtime.mas.options import RunOptions
from jacaros.runtime.mas.system import System

Statuses = dict[str, Any]


class Silent:
    """A console that shows nothing."""

    def print(self, agent: str, text: str) -> None:
        """Nothing."""

    def log(self, text: str, level: str = "info") -> None:
        """Nothing."""


def watched(
    program: str, folder: Path, seconds: float, at_end: Callable[[System], None] | None = None
) -> list[Statuses]:
    """Run a lone program for some seconds of virtual time; the statuses of each message by name."""
    path = folder / "bob.asl"
    path.write_text(program, encoding="utf-8")
    clock, messages = VirtualClock(), []
    console: RunConsole = Silent()

    async def main() -> None:
        options = RunOptions(fast=True, diagnostics=True, seed=1)
        system = System(load_deployment(path), clock, console, options)
        await system.start()
        shared: Any = system.ros.backend()
        monitor = open_backend("memory", clock, "monitor", graph=shared.graph)
        await monitor.start()
        monitor.subscription(TOPIC, TYPE, lambda sample: messages.append(sample.message))
        await clock.sleep(seconds)
        if at_end is not None:
            at_end(system)
        await system.close()
        await clock.sleep(0.1)
        await monitor.close()

    run(main, clock)
    return [{status.name: status for status in message.status} for message in messages]


def figures(status: Any) -> dict[str, str]:
    return {pair.key: pair.value for pair in status.values}


def test_once_a_second_there_is_a_status_for_the_connection_and_for_each_agent(tmp_path: Path) -> None:
    messages = watched("!wait. +!wait <- .wait(60000).", tmp_path, 3.5)
    assert len(messages) == 4, "one a second, and one at the end"
    assert set(messages[0]) == {"bob: connection", "bob: agent bob"}
    connection, agent = messages[0]["bob: connection"], messages[0]["bob: agent bob"]
    assert (connection.level, connection.message) == (OK, "connected")
    assert figures(connection) == {"middleware": "memory", "node": "/bob", "connection losses": "0"}
    assert (agent.level, agent.message) == (OK, "reasoning")
    assert figures(agent)["intentions"] == "1"
    assert int(figures(agent)["cycles per second"]) > 0
    assert figures(messages[2]["bob: agent bob"])["cycles per second"] == "0"


def test_a_queue_that_grows_for_some_seconds_is_a_warning(tmp_path: Path) -> None:
    def look(system: System) -> None:
        host = system.directory.find("bob")
        assert host is not None
        assert isinstance(host.mind, Mind)
        vitals = AgentHealth(host)
        levels = []
        for more in (60, 60, 60, 60, 0):
            # No agent has a turn meanwhile, so the queue only grows.
            host.mind.incoming.percepts.extend([[]] * more)
            levels.append(vitals.look(1.0).level)
        assert levels == [OK, OK, WARN, WARN, OK]
        host.mind.incoming.percepts.clear()

    watched("!wait. +!wait <- .wait(60000).", tmp_path, 0.5, look)


def test_a_defect_is_an_error(tmp_path: Path) -> None:
    messages = watched("!wait. +!wait <- .wait(60000).", tmp_path, 1.5, lambda s: s.fail(KeyError("oh")))
    assert "bob: run" not in messages[0]
    assert messages[-1]["bob: run"].message == "internal error: KeyError: 'oh'"
