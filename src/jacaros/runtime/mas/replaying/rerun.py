"""A rerun: a changed program gets the inputs of an agent in a recorded run, on the virtual clock."""

import asyncio
from bisect import bisect
from collections.abc import Sequence
from functools import partial
from itertools import groupby
from pathlib import Path

from jacaros.agents.language.diagnostics import AslError
from jacaros.agents.language.loader import parse_term
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.mind.state.act import Act, SpeechAct
from jacaros.agents.terms.text import text
from jacaros.look.records.records import Data, Record, is_well_formed
from jacaros.look.why.chains import shown
from jacaros.look.why.past import Past
from jacaros.runtime.clock import VirtualClock, run
from jacaros.runtime.errors import UsageError
from jacaros.runtime.mas.agents.host import AgentHost
from jacaros.runtime.mas.embedding.mas import Mas
from jacaros.runtime.mas.embedding.running_agent import RunningAgent
from jacaros.runtime.mas.replaying.differences import Comparison, compare
from jacaros.runtime.mas.replaying.recording import Input, RecordedAction, RecordedActs, completion, inputs_of

AT_ONCE = 1e-3
"""Seconds by which an action of the rerun may begin earlier or later than the recorded one, and still end with it."""
TURNS = 5
"""Turns of the event loop between two inputs of the same moment."""


def replay_against(records: Sequence[Record], program: Path, agent: str = "") -> Comparison:
    """Run a program with the recorded inputs of an agent, and compare its decisions with the recorded ones.

    Args:
        records: records of the run.
        program: the changed program, a ``.asl`` file.
        agent: the agent whose inputs the program gets. Optional if the recording has one agent.

    Raises:
        UsageError: the recording has no such agent, or no decisions of it.
        AslError: the program has errors.
    """
    records = [each for each in records if is_well_formed(each[1], each[2])]
    past = Past.of(records)
    name = _agent_of(past, agent)
    rerun = _Rerun(records, past, program, name)
    now = run(rerun.run, VirtualClock())
    return compare(records, now, name, rerun.unanswered, rerun.unreadable)


def _agent_of(past: Past, agent: str) -> str:
    names = list(dict.fromkeys(data.agent for _, data in past.deliberations))
    if not names:
        raise UsageError("error: no decisions in the recording\n  = help: record the run again with --record")
    if not agent and len(names) == 1:
        return names[0]
    if agent in names:
        return agent
    what = f"unknown agent: `{agent}`" if agent else "the recording has several agents"
    raise UsageError(f"error: {what}\n  = help: --agent with one of {', '.join(names)}")


class _Rerun:
    """One rerun.

    Attributes:
        unanswered: actions that wait, because their end was not recorded.
        unreadable: inputs that were truncated when they were recorded, and are ignored.
    """

    def __init__(self, records: Sequence[Record], past: Past, program: Path, name: str) -> None:
        self._records = records
        given = inputs_of(records, name)
        first = min((each.t for each in given), default=0.0)
        self._initial = [
            each for each in given if each.t == first and each.kind in ("add_belief", "post_goal")
        ]
        self._inputs = [each for each in given if each not in self._initial]
        self._acts = RecordedActs(records, name)
        self._over: set[int] = set()
        self._begun: dict[int, Act] = {}
        self._end, self._program, self._name = past.end, program, name
        self._began = past.began.get(name, 0.0)
        self._others = [each for each in past.began if each != name]
        self._seed = next((data.get("seed") for _, event, data in records if event == "run"), None)
        self.unanswered: list[str] = []
        self.unreadable = 0
        self._sent: list[SpeechAct] = []
        self._early: list[Input] = []

    async def run(self) -> list[Record]:
        found: list[Record] = []
        async with Mas(seed=self._seed, on_print=_ignore, on_log=_ignore) as mas:
            self._clock = mas.system.clock
            self._history = history = mas.system.keep_history()
            history.listen(lambda t, event, data: found.append((t, event, _with_short_names(event, data))))
            # They do nothing: programs look up names, and messages are in the recording.
            for other in self._others:
                mas.add_agent(other, "")
            await mas.sleep(self._began)
            agent = self._begin(mas)
            active = self._activity()
            for t, moment in groupby(self._moments(), lambda each: each[0]):
                await mas.sleep(max(0.0, t - history.t()))
                for _, group in groupby(moment, lambda each: bisect(active, each[1])):
                    for _, _, each in group:
                        self._happen(agent, each)
                    await _turns()
            await mas.sleep(max(0.0, self._end - history.t()))
        return found

    def _begin(self, mas: Mas) -> RunningAgent:
        beliefs, goals = (
            ", ".join(each.text for each in self._initial if each.kind == kind)
            for kind in ("add_belief", "post_goal")
        )
        agent = mas.add_agent(self._name, self._program, beliefs=beliefs, goals=goals)
        host = mas.system.directory.find(self._name)
        assert host is not None, "it has just been added"
        self._host: AgentHost = host
        self._host.intercept = self._act
        self._host.intercept_stop = lambda delay, code: True
        self._host.send = self._send
        return agent

    def _moments(self) -> list[tuple[float, int, Input | RecordedAction]]:
        """Return all that happens to the agent, in the order of the recording."""
        inputs: list[tuple[float, int, Input | RecordedAction]] = [
            (each.t, each.order, each) for each in self._inputs
        ]
        ends = {
            data["id"]: order for order, (_, event, data) in enumerate(self._records) if event == "operation"
        }
        for act in self._acts.ends():
            assert act.ended is not None, "its end is known"
            assert act.end is not None
            inputs.append((act.ended, ends[act.end.id], act))
        return sorted(inputs, key=lambda each: each[:2])

    def _activity(self) -> list[int]:
        """Return the numbers of the agent's own records: between two of them it had no turn."""
        return [
            order
            for order, (_, event, data) in enumerate(self._records)
            if event in ("deliberation", "goal") and data.get("agent") == self._name
        ]

    def _happen(self, agent: RunningAgent, each: Input | RecordedAction) -> None:
        if isinstance(each, Input):
            self._give(agent, each)
            return
        self._over.add(id(each))
        act = self._begun.pop(id(each), None)
        if act is not None:
            self._finish(act, each)

    def _finish(self, act: Act, recorded: RecordedAction) -> None:
        assert self._host.mind is not None, "it runs a program"
        self._host.mind.complete(act.id, completion(recorded, act))

    def _act(self, act: Act) -> bool:
        now = self._history.t()
        recorded = self._acts.take(act, now)
        if recorded is None or recorded.ended is None:
            self.unanswered.append(
                shown(text((act.functor, *act.arguments) if act.arguments else act.functor))
            )
        elif recorded.end and id(recorded) not in self._over and abs(now - recorded.began) < AT_ONCE:
            self._begun[id(recorded)] = act  # it ends at its place among the other records
        else:
            self._clock.call_later(recorded.ended - recorded.began, partial(self._finish, act, recorded))
        return True

    def _send(self, message: SpeechAct) -> bool:
        if message.receiver == self._name:
            self._host.receive(message)
            return True
        self._sent.append(message)
        for each in [each for each in self._early if _answers(each, message)]:
            self._early.remove(each)
            # Later: the agent waits for the answer only after its question is sent.
            asyncio.get_running_loop().call_soon(self._receive, each, message)
        return True

    def _give(self, agent: RunningAgent, each: Input) -> None:
        try:
            if each.kind != "message":
                getattr(agent, each.kind)(each.text)
            elif not each.question:
                self._receive(each, None)
            else:
                question = next((sent for sent in self._sent if _answers(each, sent)), None)
                if question is None:
                    self._early.append(each)  # the program may ask later
                else:
                    self._sent.remove(question)
                    self._receive(each, question)
        except (AslError, ValueError):
            self.unreadable += 1

    def _receive(self, each: Input, question: SpeechAct | None) -> None:
        message, content = each.message, lower_value(parse_term(each.text))
        answered = None if question is None else question.id
        number = f"recorded{message.get('id')}"
        self._host.receive(
            SpeechAct(message["performative"], message["from"], self._name, content, number, answered)
        )


async def _turns() -> None:
    """Let the agent handle its inputs before the next one of the same moment."""
    for _ in range(TURNS):
        await asyncio.sleep(0)


def _with_short_names(event: str, data: Data) -> Data:
    """Return a record of the rerun with file names relative to the current folder."""
    if event != "program":
        return data
    here = f"{Path.cwd()}/"
    return {**data, "plans": [{**each, "file": each["file"].removeprefix(here)} for each in data["plans"]]}


def _ignore(*_: str) -> None:
    """Ignore output and logs of the program, which the recorded run has shown."""


def _answers(answer: Input, question: SpeechAct) -> bool:
    asked = answer.question
    return (
        asked.get("to") == question.receiver
        and asked.get("performative") == question.performative
        and shown(asked.get("content")) == shown(text(question.content))
    )
