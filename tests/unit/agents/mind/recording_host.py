"""A host for minds in tests: keeps what they do, and rings timers in virtual time."""

import heapq
import itertools
import os
import re
from collections.abc import Callable, Mapping, Sequence
from random import Random
from textwrap import dedent
from typing import Any

import pytest

import jacaros.agents.mind.actions.standard  # noqa: F401 - fills the registry of internal actions
from jacaros.agents.language.loader import load_program
from jacaros.agents.language.nodes import Program
from jacaros.agents.mind.actions.internal_action import STANDARD, InternalAction
from jacaros.agents.mind.mind import Mind, new_engine
from jacaros.agents.mind.state.act import Act, Completion, SpeechAct
from jacaros.agents.mind.state.budget import Options
from jacaros.agents.mind.state.plan_library import ProgramPlans
from jacaros.agents.terms.text import text

STARTED = 1_577_836_800.0
"""The time at which runs begin."""


class Ring:
    """A timer of the test's own time."""

    def __init__(self, callback: Callable[[], None]) -> None:
        self.callback: Callable[[], None] | None = callback

    def cancel(self) -> None:
        self.callback = None


class RecordingHost:
    """Implements the port of a mind; time stands still until `run` has nothing else to do."""

    def __init__(self, complete: Callable[[Act], Completion | None] | None = None) -> None:
        self.random = Random(1)
        self.time = STARTED
        self.printed: list[str] = []
        self.logged: list[tuple[str, str]] = []
        self.acts: list[Act] = []
        self.cancelled: list[int] = []
        self.suspended: list[int] = []
        self.resumed: list[int] = []
        self.files: dict[str, str] = {}
        self.registered: list[str] = []
        self.system = self.services = self
        self.sent: list[SpeechAct] = []
        self.stopped = False
        self.memory_errors = 0
        self.goals_lost = 0
        self.exit_code = 0
        self.agent: Mind
        self._complete = complete
        self._timers: list[tuple[float, int, Ring]] = []
        self._numbers = itertools.count()

    def now(self) -> float:
        return self.time

    def ready(self) -> None:
        pass

    def set_timer(self, delay: float, callback: Callable[[], None]) -> Ring:
        ring = Ring(callback)
        heapq.heappush(self._timers, (self.time + delay, next(self._numbers), ring))
        return ring

    def act(self, act: Act) -> None:
        self.acts.append(act)
        completion = self._complete(act) if self._complete is not None else None
        if completion is not None:
            self.agent.complete(act.id, completion)

    def cancel_act(self, act_id: int) -> None:
        self.cancelled.append(act_id)

    def suspend_act(self, act_id: int) -> None:
        self.suspended.append(act_id)

    def resume_act(self, act_id: int) -> None:
        self.resumed.append(act_id)

    def send(self, message: SpeechAct) -> bool:
        self.sent.append(message)
        if message.receiver == self.agent.name:
            self.agent.receive(message)
            return True
        return message.receiver == "friend"

    def agent_names(self) -> Sequence[str]:
        return [self.agent.name, "friend"]

    def print(self, text: str) -> None:
        self.printed.append(text)

    def log(self, level: str, text: str) -> None:
        self.logged.append((level, text))

    def goal_lost(self) -> None:
        self.goals_lost += 1

    def out_of_memory(self) -> None:
        self.memory_errors += 1

    def stop_system(self, delay: float, exit_code: int) -> None:
        del delay
        self.stopped, self.exit_code = True, exit_code
        self.agent.stopped = True

    def create_agent(self, name: str, source: str | None, classes: Mapping[str, str]) -> str | None:
        del name, source
        return None

    def explain(self, question: str, agent: str) -> Mapping[str, Any]:
        fact = {"kind": "sample", "text": "/battery", "t": 0.5, "agent": "", "file": "", "line": 0}
        return {"answer": question, "t": 1.0, "facts": (), "because": (fact,)}

    def clone_agent(self, original: str, name: str) -> str | None:
        del original, name
        return None

    def kill_agent(self, name: str, delay: float, killer: str) -> bool:
        del name, delay, killer
        return False

    def read_program(self, path: str) -> tuple[str, str]:
        raise FileNotFoundError(path)

    def list_files(self, folder: str) -> Sequence[str]:
        raise FileNotFoundError(folder)

    def write_file(self, path: str, text: str) -> None:
        self.files[path] = text

    def register(self, name: str, service: str) -> None:
        self.registered.append(service)

    def deregister(self, name: str, service: str) -> None:
        self.registered.remove(service)

    def providers(self, service: str) -> Sequence[str]:
        return [self.agent.name] if service in self.registered else []

    def subscribe(self, name: str, service: str) -> None:
        pass

    def run(self, fuel: int = 1000, seconds: float = 1000.0) -> None:
        """Let the agent run, and time pass, until it stops, is idle for good, or time is up."""
        end = self.time + seconds
        while not self.stopped:
            while self.agent.run(fuel):
                pass
            if self.stopped or not self.ring_next(end):
                return

    def ring_next(self, end: float) -> bool:
        """Ring the next timer that is due before *end*; return False without one."""
        while self._timers and self._timers[0][2].callback is None:
            heapq.heappop(self._timers)
        if not self._timers or self._timers[0][0] > end:
            return False
        moment, _, ring = heapq.heappop(self._timers)
        self.time = max(self.time, moment)
        assert ring.callback is not None
        ring.callback()
        return True


def mind(
    program: str,
    *,
    name: str = "tester",
    complete: Callable[[Act], Completion | None] | None = None,
    options: Options | None = None,
    path: str = "",
) -> RecordingHost:
    """An agent with this program, begun but not yet run; the host gives access to it."""
    host = RecordingHost(complete)
    tree, _ = load_program(path or f"{name}.asl", program, _reader(path))
    host.agent = Mind(name, tree, host, options, plans=plans_of(tree))
    host.agent.start()
    return host


def plans_of(program: Program, actions: Mapping[str, InternalAction] = STANDARD) -> ProgramPlans:
    """The plans of a program, run by the engine that the environment names."""
    plain = os.environ.get("JACAROS_PLAIN", "0") not in ("", "0")
    return ProgramPlans(program.plans, new_engine(actions, plain))


def _reader(path: str) -> Callable[[str, str], tuple[str, str]]:
    def read(wanted: str, including: str) -> tuple[str, str]:
        del including
        found = os.path.join(os.path.dirname(path), wanted)
        with open(found, encoding="utf-8") as file:
            return found, file.read()

    return read


def ran(program: str, seconds: float = 1000.0, **arguments: object) -> RecordingHost:
    """An agent with this program that has run."""
    host = mind(program, **arguments)  # type: ignore[arg-type]
    host.run(seconds=seconds)
    return host


def printed(program: str, **arguments: object) -> list[str]:
    """What an agent with this program prints."""
    return ran(program, **arguments).printed  # type: ignore[arg-type]


def outcome(host: RecordingHost) -> list[str]:
    """What an agent has printed, how much time has passed (``@0.5``), and which acts it has cancelled."""
    seconds = round(host.time - STARTED, 3)
    time = [f"@{seconds}"] if seconds else []
    return [*host.printed, *time, *(f"cancelled {number}" for number in host.cancelled)]


def programs(cases: str) -> pytest.MarkDecorator:
    """Parametrize a test with programs and their outputs: a line ``name => one | two``, then the program, indented.

    A long output has lines of its own after the name. With names that end in a time limit, as in ``name; 2.5 s``, the test
    gets that of each program, too.
    """
    found: list[Any] = []
    limited = re.search(r"; [0-9.]+ s\s=>", cases) is not None
    for case in re.split(r"^(?=[^\s=|])", cases.lstrip("\n"), flags=re.MULTILINE)[1:]:
        name, rest = re.split(r"\s=>", case, maxsplit=1)
        output, program = re.split(r"\n(?!\|)", rest, maxsplit=1)
        case = [dedent(program), output.replace("\n|", " |").strip().split(" | ") if output else []]
        if limited:
            case.append(float(limit[1]) if (limit := re.search(r"; ([0-9.]+) s$", name)) else 60.0)
        found.append(pytest.param(*case, id=name))
    return pytest.mark.parametrize(
        ("program", "output", "limit") if limited else ("program", "output"), found
    )


def believed(host: RecordingHost, name: str) -> list[str]:
    """The beliefs of that functor as text, in the order in which they answer."""

    return [
        text(literal)
        for literal in host.agent.beliefs.literals()
        if text(literal).lstrip("~").startswith(name)
    ]
