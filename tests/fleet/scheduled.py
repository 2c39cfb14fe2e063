"""A fleet on a simulated network that does random things, and notes all that it does and what became of it."""

import asyncio
from collections import defaultdict
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import count
from random import Random
from typing import ClassVar

from queues import SimulatedNetwork

from jacaros import Mas
from jacaros.agents.mind.state.act import SpeechAct
from jacaros.agents.mind.state.plan import Failure
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import String
from jacaros.artifacts import Artifact, operation
from jacaros.artifacts.env.environment import Environment
from jacaros.artifacts.env.errors import ArtifactId, OperationFailed
from jacaros.artifacts.env.operation import OperationOutcome, OperationRequest
from jacaros.artifacts.env.property import Observation
from jacaros.fleet.carrier import MemberId
from jacaros.fleet.member import Member
from jacaros.fleet.rights import Rights
from jacaros.runtime.clock import clock_of
from jacaros.runtime.mas.system import System

CALM = 14.0
"""Seconds after which everything has an outcome once the network is whole."""


class Counter(Artifact):
    """Notes the effects of its operations."""

    effects: ClassVar[list[tuple[int, float]]]

    def init(self) -> None:
        self.define_property("count", 0)
        self.define_property("last", "")

    @operation
    def note(self, number: int) -> None:
        """Have an effect immediately."""
        self._effect(number)

    @operation
    async def note_later(self, number: int, delay: float) -> None:
        """Have an effect after a while."""
        await self.sleep(delay)
        self._effect(number)

    def _effect(self, number: int) -> None:
        self.effects.append((number, self.clock.elapsed))
        self.update_property("count", self.value("count") + 1)
        self.update_property("last", f"n{number}")
        self.signal("noted", number)


class Note:
    """Something that was sent or asked for, and what became of it.

    Attributes:
        outcomes: what was reported to the one who did it.
        arrivals: how often it arrived.
        ended_at: seconds at which an operation got its outcome.
        refused_by: the run that has no such receiver, and says so, unless it is killed meanwhile.
    """

    def __init__(self, what: str, by: "Run", to: str) -> None:
        self.what, self.by, self.to = what, by, to
        self.outcomes: list[str] = []
        self.arrivals = 0
        self.refused_by: Run | None = None
        self.ended_at = 0.0

    def __repr__(self) -> str:
        return f"{self.what} of {self.by.id} to {self.to}: {self.outcomes}, arrived {self.arrivals} times"


class Observed:
    """Observes an artifact, and checks that what it hears fits together."""

    def __init__(self, agent: str, faults: list[str]) -> None:
        self.agent, self._faults = agent, faults
        self.known: dict[int, tuple[str, tuple[object, ...]]] = {}
        self.signals: list[object] = []
        self.outcomes: list[bool] = []
        self.ended = False

    def observe(self, seen: Observation) -> None:
        """Hear of changes."""
        self.signals += [each.arguments[0] for each in seen.signals]
        for old, new in seen.changed:
            self._expect(self.known.get(old.key) == (old.name, old.values), f"changed unknown {old}")
            self.known[new.key] = new.name, new.values
        for new in seen.added:
            self._expect(new.key not in self.known, f"added known {new}")
            self.known[new.key] = new.name, new.values
        for old in seen.removed:
            self._expect(self.known.pop(old.key, None) is not None, f"removed unknown {old}")

    def _expect(self, fits: bool, fault: str) -> None:
        if not fits:
            self._faults.append(f"observer of {self.agent}: {fault}")


class Agent:
    """Stands for an agent: notes what it receives, and answers questions."""

    def __init__(self, name: str, run: "Run", fleet: "Fleet") -> None:
        self.name, self._run, self._fleet = name, run, fleet

    def receive(self, message: SpeechAct) -> None:
        """Receive a message."""
        fleet = self._fleet
        if message.performative == "undelivered":
            if (note := fleet.notes.get(message.in_reply_to or "")) is None:
                return  # an answer, which its asker has an outcome for
            note.outcomes.append(text(message.content).rpartition(",")[2].rstrip(")"))
        elif message.in_reply_to is not None:
            fleet.notes[message.in_reply_to].outcomes.append("answer")
        else:
            note = fleet.notes[message.id]
            note.arrivals += 1
            fleet.arrived[note.by.id, self._run.id].append(int(message.id))
            if message.performative == "askOne":
                clock = self._run.mas.clock
                clock.call_later(fleet.random.random() * 2, lambda: self._answer(message))

    def _answer(self, asked: SpeechAct) -> None:
        if not self._run.ended:
            answer = SpeechAct("tell", self.name, asked.sender, asked.content, f"a{asked.id}", asked.id)
            self._run.system.deliver(answer)

    def halt(self) -> None: ...

    def end(self) -> None: ...

    async def close(self) -> None: ...


@dataclass(eq=False)
class Run:
    """One run of a member."""

    id: MemberId
    mas: Mas
    agents: list[Agent] = field(default_factory=list)
    effects: list[tuple[int, float]] = field(default_factory=list)
    own: list[ArtifactId] = field(default_factory=list)
    services: set[tuple[str, str]] = field(default_factory=set)
    focuses: dict[tuple[ArtifactId, str], Observed] = field(default_factory=dict)
    member: Member | None = None
    counter: type[Counter] = Counter
    ended: bool = False

    @property
    def system(self) -> System:
        """Its system."""
        return self.mas.system

    @property
    def environment(self) -> Environment:
        """Its environment."""
        return self.mas.environment


class Fleet:
    """A fleet that plays one random schedule.

    Args:
        seed: what to play.

    Attributes:
        notes: messages, questions and operations by number.
        arrived: numbers of messages between two runs, in the order of arrival.
        faults: what cannot be.
        log: warnings.
    """

    def __init__(self, seed: int) -> None:
        random = self.random = Random(seed)
        self.network = SimulatedNetwork(clock_of(asyncio.get_running_loop()), seed)
        self.clock = self.network.clock
        self.names = [f"m{number}" for number in range(random.randint(2, 4))]
        self.runs: dict[str, Run] = {}
        self.ended: list[Run] = []
        self.notes: dict[str, Note] = {}
        self.arrived: dict[tuple[MemberId, MemberId], list[int]] = defaultdict(list)
        self.operations: list[Note] = []
        self.faults: list[str] = []
        self.log: list[str] = []
        self._numbers = count(1)
        self._closing: list[asyncio.Task[None]] = []
        self._common = random.random() < 0.3

    # ---- its members

    async def begin(self, name: str) -> None:
        """Start a member."""
        id = MemberId(name, f"{next(self._numbers):06d}")

        async def join(system: System) -> Callable[[], object]:
            member = run.member = Member(system, self.network.carrier(), id, Rights())
            await member.join()
            return member.leave

        mas = Mas(name=name, on_log=lambda line, level: self._logged(name, line, level), join=join)  # type: ignore[arg-type]
        run = Run(id, mas)
        await mas.__aenter__()
        self.runs[name] = run
        for each in (f"{name}_a", "common" if self._common else f"{name}_b"):
            agent = Agent(each, run, self)
            run.agents.append(agent)
            mas.system.directory.add(each, agent)  # type: ignore[arg-type]
        run.counter = type("Counter", (Counter,), {"effects": run.effects})
        mas.add_artifact_types(run.counter)
        path = mas.create_workspace(f"lab_{name}")
        run.own.append(await mas.make_artifact("counter", run.counter, workspace=path))

    def _logged(self, name: str, line: str, level: str) -> None:
        self.log.append(f"{name}: {line}")
        if level == "error" or "valid message" in line:
            self.faults.append(f"{name}: {line}")

    def kill(self, name: str) -> None:
        """End a member without a word."""
        self.network.kill(name)
        self._end(name)

    def _end(self, name: str) -> None:
        run = self.runs.pop(name)
        run.ended = True
        self.ended.append(run)
        self._closing.append(asyncio.ensure_future(run.mas.__aexit__(None, None, None)))

    async def stop(self) -> None:
        """End all members."""
        for name in list(self.runs):
            self.network.kill(name)
            self._end(name)
        await asyncio.gather(*self._closing)

    # ---- a schedule

    async def play(self) -> None:
        """Play the schedule, and wait until the network has been whole for a while."""
        for name in self.names:
            await self.begin(name)
        random, network = self.random, self.network
        network.delay, network.spread = random.choice([0.001, 0.02, 0.2]), random.choice([0.0, 0.01, 0.3])
        network.loss, network.doubling = random.choice([0.0, 0.1, 0.3]), random.choice([0.0, 0.1, 0.3])
        actions = [
            *[self._send] * 6,
            *[self._ask] * 2,
            *[self._operate] * 5,
            *[self._focus] * 3,
            self._stop_focus,
        ]
        actions += [
            self._serve,
            self._serve,
            self._hire,
            self._dispose,
            self._create,
            self._cut,
            *[self._doubt] * random.choice([1, 5]),
            self._restart,
        ]
        for _ in range(random.randint(20, 60)):
            if self.runs:
                for _ in range(random.choice([1, 1, 1, 5])):
                    await random.choice(actions)()
            await self.clock.sleep(random.choice([0.0, 0.01, 0.1, 0.5, 1.0]) * random.random())
        network.loss = network.doubling = 0.0
        for one in self.names:
            for other in self.names:
                network.heal(one, other)
        for name in self.names:
            if name not in self.runs:
                await self.begin(name)
        await self.clock.sleep(CALM)

    def _pair(self) -> tuple[Run, str]:
        run = self.random.choice(list(self.runs.values()))
        return run, self.random.choice([name for name in self.names if name != run.id.name])

    async def _send(self) -> None:
        self._say("tell")

    async def _ask(self) -> None:
        self._say("askOne")

    def _say(self, performative: str) -> None:
        run, to = self._pair()
        number = str(next(self._numbers))
        note = self.notes[number] = Note(performative, run, to)
        agent = self.random.choice([f"{to}_a", "common" if self._common else f"{to}_b", "nobody"])
        note.refused_by = self.runs.get(to) if agent == "nobody" else None
        sender = run.agents[self.random.randint(0, 1)].name
        message = SpeechAct(performative, sender, f"{agent}@{to}", String(number), number)
        try:
            if not run.system.deliver(message):
                note.outcomes.append("refused")
        except Failure as failure:
            self.faults.append(f"{note}: {failure}")

    def _artifact(self, run: Run, to: str) -> ArtifactId | None:
        for workspace in run.environment.workspaces():
            if workspace.path == f"/main/lab_{to}" and (artifacts := list(workspace.artifacts())):
                return self.random.choice(
                    [each for each in artifacts if each.type_name.endswith("Counter")] or [None]
                )
        return None

    async def _operate(self) -> None:
        run, to = self._pair()
        artifact = self._artifact(run, to)
        if artifact is None:
            return
        number = next(self._numbers)
        note = self.notes[str(number)] = Note("operation", run, to)
        self.operations.append(note)
        later = self.random.random() < 0.5
        delay = self.random.choice([0.1, 2.0, 10.0]) * self.random.random()
        arguments = (number, delay) if later else (number,)

        def done(outcome: OperationOutcome) -> None:
            note.ended_at = self.clock.elapsed
            note.outcomes.append("ok" if outcome.ok else str(outcome.reason))

        request = OperationRequest(artifact, "note_later" if later else "note", arguments, run.agents[0].name)
        request.on_done = done
        run.environment.execute(request)

    async def _focus(self) -> None:
        run, to = self._pair()
        artifact = self._artifact(run, to)
        if artifact is None:
            return
        agent = run.agents[self.random.randint(0, 1)].name
        observed = run.focuses.get((artifact, agent))
        if observed is None:
            observed = run.focuses[artifact, agent] = Observed(agent, self.faults)
        heard = observed

        def done(outcome: OperationOutcome) -> None:
            heard.outcomes.append(outcome.ok)
            if outcome.ok and not heard.ended and not heard.known:
                self.faults.append(f"{run.id} focused {artifact.path} without its properties")

        run.environment.workspace(artifact.workspace).focus(artifact, observed, done)

    async def _stop_focus(self) -> None:
        run, _ = self._pair()
        if run.focuses:
            key = self.random.choice(list(run.focuses))
            artifact, observed = key[0], run.focuses.pop(key)
            observed.ended = True
            with suppress(OperationFailed):  # its workspace may be gone
                run.environment.workspace(artifact.workspace).stop_focus(artifact, observed)
            if observed.known:
                self.faults.append(f"{run.id} stopped to focus {artifact.path} and keeps {observed.known}")

    async def _serve(self) -> None:
        run, _ = self._pair()
        agent, service = self.random.choice(run.agents).name, self.random.choice(["mop", "wipe"])
        if (agent, service) in run.services:
            run.services.discard((agent, service))
            run.system.services.deregister(agent, service)
        else:
            run.services.add((agent, service))
            run.system.services.register(agent, service)

    async def _hire(self) -> None:
        """Add an agent whose name others may have, or remove it."""
        run, _ = self._pair()
        late = next((each for each in run.agents if each.name == "late"), None)
        if late is None:
            run.agents.append(Agent("late", run, self))
            run.system.directory.add("late", run.agents[-1])  # type: ignore[arg-type]
            return
        for agent, service in [each for each in run.services if each[0] == "late"]:
            run.services.discard((agent, service))
            run.system.services.deregister(agent, service)
        run.agents.remove(late)
        run.system.directory.remove("late")

    async def _create(self) -> None:
        run, to = self._pair()
        if self.random.random() < 0.5:
            run.own.append(
                await run.mas.make_artifact(
                    f"box{next(self._numbers)}", run.counter, workspace=f"/main/lab_{run.id.name}"
                )
            )
            return
        note = Note("creation", run, to)
        for workspace in run.environment.workspaces():
            if workspace.path == f"/main/lab_{to}":
                self.operations.append(note)

                def done(artifact: ArtifactId | None, outcome: OperationOutcome) -> None:
                    note.outcomes.append("made" if outcome.ok else str(outcome.reason))
                    if outcome.ok and artifact is None and not note.by.ended:
                        self.faults.append(f"{note}: created without an artifact")

                workspace.create(f"far{next(self._numbers)}", "Counter", (), None, done)

    async def _dispose(self) -> None:
        run, to = self._pair()
        if self.random.random() < 0.5 and len(run.own) > 1:
            artifact: ArtifactId | None = run.own.pop()
        else:
            artifact = self._artifact(run, to)
        if artifact is None:
            return
        note = Note("disposal", run, to)
        self.operations.append(note)
        try:
            run.environment.workspace(artifact.workspace).dispose_artifact(
                artifact, lambda outcome: note.outcomes.append("ok" if outcome.ok else str(outcome.reason))
            )
        except OperationFailed as failure:
            note.outcomes.append(str(failure.reason))

    # ---- what happens to the network

    async def _cut(self) -> None:
        random, network = self.random, self.network
        run, to = self._pair()
        network.notice = random.choice([0.01, 0.1, 1.0])
        network.cut(run.id.name, to, random.random() < 0.5)
        seconds = random.choice([0.1, 1.0, 5.0, 5.0, 70.0]) * random.random()
        self.clock.call_later(seconds, lambda: network.heal(run.id.name, to))

    async def _doubt(self) -> None:
        run, to = self._pair()
        self.network.notice_loss(run.id.name, to, self.random.random())

    async def _restart(self) -> None:
        name = self.random.choice(self.names)
        if self.random.random() < 0.5:
            return
        if name in self.runs:
            self.kill(name)
            await self.clock.sleep(self.random.choice([0.0, 0.05, 1.0, 4.0]) * self.random.random())
        if name not in self.runs:
            await self.begin(name)
