"""A rerun: a changed program is given what an agent was given in a recorded run, on the virtual clock."""

from collections.abc import Sequence
from pathlib import Path

from jacaros.asl.diagnostics import AslError
from jacaros.asl.loader import parse_term
from jacaros.asl.lowering import lower_value
from jacaros.bdi.state.act import Act
from jacaros.bdi.state.speech_act import SpeechAct
from jacaros.clock import VirtualClock, run
from jacaros.errors import UsageError
from jacaros.mas.agent_host import AgentHost
from jacaros.mas.embedding.mas import Mas
from jacaros.mas.embedding.running_agent import RunningAgent
from jacaros.mas.history.chains import shown
from jacaros.mas.history.past import Data, Past, Record
from jacaros.mas.replaying.differences import Comparison, compare
from jacaros.mas.replaying.recorded_acts import RecordedActs, completion
from jacaros.mas.replaying.recorded_inputs import Input, inputs_of
from jacaros.terms.text import text


def replay_against(records: Sequence[Record], program: Path, agent: str = "") -> Comparison:
    """Give a program what an agent was given in a recorded run, and compare its decisions with the recorded ones.

    Args:
        records: of the run.
        program: the changed program, a ``.asl`` file.
        agent: whose percepts and messages the program gets; not needed if the recording has one agent.

    Raises:
        UsageError: the recording has no such agent, or no decisions of it.
        AslError: the program is wrong.
    """
    past = Past.of(records)
    name = _agent_of(past, agent)
    rerun = _Rerun(records, past, program, name)
    now = run(rerun.run, VirtualClock())
    return compare(records, now, name, rerun.unanswered, rerun.unreadable)


def _agent_of(past: Past, agent: str) -> str:
    names = list(dict.fromkeys(str(data["agent"]) for _, data in past.deliberations))
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
        unanswered: actions that wait, since the recording has no end for them.
        unreadable: inputs that were cut off when they were recorded, and are left out.
    """

    def __init__(self, records: Sequence[Record], past: Past, program: Path, name: str) -> None:
        self._inputs, self._acts = inputs_of(records, name), RecordedActs(records, name)
        self._end, self._program, self._name = past.end, program, name
        self._began = past.agents.get(name, (0.0, ""))[0]
        self._seed = next((data.get("seed") for _, event, data in records if event == "run"), None)
        self.unanswered: list[str] = []
        self.unreadable = 0
        self._sent: list[SpeechAct] = []
        self._early: list[Input] = []

    async def run(self) -> list[Record]:
        """The records of the rerun."""
        found: list[Record] = []
        async with Mas(seed=self._seed, on_print=_ignore, on_log=_ignore) as mas:
            self._clock = mas.system.clock
            history = mas.system.keep_history()
            history.listen(lambda t, event, data: found.append((t, event, _with_short_names(event, data))))
            await mas.sleep(self._began)
            agent = self._begin(mas)
            for each in self._inputs:
                await mas.sleep(max(0.0, each.t - history.t()))
                self._give(agent, each)
            await mas.sleep(max(0.0, self._end - history.t()))
        return found

    def _begin(self, mas: Mas) -> RunningAgent:
        agent = mas.add_agent(self._name, self._program)
        host = mas.system.directory.find(self._name)
        assert host is not None, "it has just been added"
        self._host: AgentHost = host
        self._host.intercept = self._act
        self._host.intercept_stop = lambda delay, code: True
        self._host.send = self._send
        return agent

    def _act(self, act: Act) -> bool:
        recorded = self._acts.take(act)
        if recorded is None or recorded.duration is None:
            self.unanswered.append(
                shown(text((act.functor, *act.arguments) if act.arguments else act.functor))
            )
        else:
            end = completion(recorded)
            self._clock.call_later(recorded.duration, lambda: self._host.mind.complete(act.id, end))
        return True

    def _send(self, message: SpeechAct) -> bool:
        if message.receiver == self._name:
            self._host.receive(message)
            return True
        self._sent.append(message)
        for each in [each for each in self._early if _answers(each, message)]:
            self._early.remove(each)
            self._receive(each, message)
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


def _with_short_names(event: str, data: Data) -> Data:
    """A record of the rerun; the files of a program are named from the current folder."""
    if event != "program":
        return data
    here = f"{Path.cwd()}/"
    return {**data, "plans": [{**each, "file": each["file"].removeprefix(here)} for each in data["plans"]]}


def _ignore(*_: str) -> None:
    """What the program prints and logs was seen in the recorded run."""


def _answers(answer: Input, question: SpeechAct) -> bool:
    """Whether a recorded answer is for a question of the rerun."""
    asked = answer.question
    return (
        asked.get("to") == question.receiver
        and asked.get("performative") == question.performative
        and shown(asked.get("content")) == shown(text(question.content))
    )
