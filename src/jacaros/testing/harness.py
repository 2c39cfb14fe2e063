"""One agent under the control of a Python test, which gives it percepts, messages and goals, and inspects what it does.

There is no environment, no other agent and no waiting: actions and messages are recorded, and virtual time advances only
when the test says so::

    def test_a_low_battery_sends_the_robot_to_the_dock() -> None:
        agent = AgentHarness(Path("robot.asl"))
        agent.perceive("battery(15)")
        agent.run()
        agent.assert_did("driveTo(1, 1)")
        agent.act("driveTo").fail("blocked")
        agent.run()
        agent.assert_printed("I need help")
"""

from asyncio import CancelledError
from collections.abc import Callable, Collection, Coroutine, Mapping, Sequence
from operator import methodcaller
from pathlib import Path
from random import Random
from typing import Any, NoReturn

import jacaros.agents.mind.actions.standard  # noqa: F401 - fills the table of internal actions
from jacaros.agents.body.values import References, to_term, to_value
from jacaros.agents.language.diagnostics import AslError
from jacaros.agents.language.loader import load_program, parse_term
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules import goals
from jacaros.agents.mind.rules.goals import WatchedGoal
from jacaros.agents.mind.state.act import Act, Completion, SpeechAct
from jacaros.agents.mind.state.budget import Options
from jacaros.agents.terms.substitution import free_variables
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import Term, Var
from jacaros.runtime.clock import Timer, VirtualClock, run
from jacaros.runtime.errors import UsageError
from jacaros.runtime.files.python_modules import ProjectModules
from jacaros.runtime.files.texts import file_text
from jacaros.runtime.mas.agents.host import Ended, without_exit
from jacaros.runtime.mas.agents.programs import Programs
from jacaros.runtime.mas.agents.python_code import PythonCode
from jacaros.runtime.mas.embedding.given import read_given
from jacaros.runtime.mas.embedding.running_agent import OpenMind, PursuedGoal, literal
from jacaros.testing.assertions import Complete, failed, matches

Action = Callable[..., object]
"""A function that answers an external action; see `RecordedAct.answer`."""


class ActionFailed(Exception):
    """Raised by a fake action to make the step fail.

    Args:
        reason: reason term as text: ``blocked(wall)`` reaches the plan as ``env_failure_reason(blocked(wall))``.
        message: message for the log (default: the reason).
    """

    def __init__(self, reason: str, message: str | None = None) -> None:
        super().__init__(message or reason)
        self.reason, self.message = reason, message


class RecordedAct:
    """An external action started by the agent.

    Attributes:
        name: name of the action.
        arguments: plain values (numbers, strings, `jacaros.artifacts.env.values.Atom`, `Structure`, lists); None for an
            output.
        pending: whether the action has not ended yet.
        term: the action as a term.
        cancelled: whether its intention was dropped.
        paused: whether its intention is suspended.
    """

    def __init__(self, act: Act, complete: Complete) -> None:
        self._act = act
        self._complete = complete
        self.term: Term = (act.functor, *act.arguments) if act.arguments else act.functor
        self._outputs = free_variables(self.term)
        self.name = act.functor.name
        self.arguments = tuple(None if a.__class__ is Var else to_value(a) for a in act.arguments)
        self.pending = True
        self.cancelled = False
        self.paused = False

    def complete(self, *outputs: object) -> None:
        """Let the action succeed; *outputs* are the values of its unbound variables, in order.

        Raises:
            ValueError: the action has already ended, or the number of outputs differs from that of the unbound variables.
        """
        if outputs and len(outputs) != len(self._outputs):
            raise ValueError(f"{self} has {len(self._outputs)} unbound variables, not {len(outputs)}")
        values = [
            (variable, to_term(value, References()))
            for variable, value in zip(self._outputs, outputs, strict=False)
        ]
        self._end(Completion(True, tuple(values)))

    def fail(self, reason: str = "failed", message: str | None = None) -> None:
        """Let the action fail.

        Args:
            reason: reason term as text.
            message: message for the log (default: the reason).

        Raises:
            ValueError: the action has already ended.
        """
        self._end(failed(lower_value(parse_term(reason)), message))

    def _end(self, completion: Completion) -> None:
        if not self.pending:
            raise ValueError(f"{self} has already ended{' with its intention' if self.cancelled else ''}")
        self.pending = False
        self._complete(self._act.id, completion)

    def answer(self, function: Action) -> None:
        """Let a function answer the action: it receives the bound arguments and returns the outputs.

        It returns a single output as such, several as a tuple; without outputs, False makes the action fail.
        `AgentHarness.run` raises any exception other than `ActionFailed`.
        """
        values = [
            a
            for a, term in zip(self.arguments, self._act.arguments, strict=True)
            if term.__class__ is not Var
        ]
        try:
            result = function(*values)
        except ActionFailed as end:
            self.fail(end.reason, end.message)
            return
        if not self._outputs:
            self.fail() if result is False else self.complete()
        elif len(self._outputs) == 1:
            self.complete(result)
        else:
            self.complete(*(result if isinstance(result, tuple) else (result,)))

    def __str__(self) -> str:
        return text(self.term)

    def __repr__(self) -> str:
        return f"<act {self}{' pending' if self.pending else ''}>"


class SentMessage:
    """A message sent by the agent.

    Attributes:
        receiver: name of the receiving agent.
        performative: performative, such as ``tell``.
        content: content as text.
    """

    def __init__(self, message: SpeechAct) -> None:
        self.receiver = message.receiver
        self.performative = message.performative
        self.content = text(message.content)
        self.term = message.content

    def __repr__(self) -> str:
        return f".send({self.receiver}, {self.performative}, {self.content})"


class HarnessPort:
    """The agent's host and the rest of its system (ports of `jacaros.agents.mind.state.act`). Records what the agent does.

    Attributes:
        mind: the agent.
        mistake: first exception of a function that answers actions, which for the agent is only a failed step.
    """

    mind: Mind

    def __init__(
        self,
        name: str,
        actions: Mapping[str, Action],
        others: Collection[str] | None,
        programs: Programs,
        file: Path,
    ) -> None:
        self.random = Random(0)
        self.clock = VirtualClock()
        self.prints: list[str] = []
        self.logs: list[str] = []
        self.acts: list[RecordedAct] = []
        self.sent: list[SentMessage] = []
        self.files: dict[str, str] = {}
        self.exit_code: int | None = None
        self.mistake: Exception | None = None
        self._name, self._actions, self._others = name, actions, others
        self._programs, self._file = programs, file
        self._by_number: dict[int, RecordedAct] = {}
        self._services: dict[str, None] = {}
        self.system = self.services = self

    def now(self) -> float:
        return self.clock.now()

    def ready(self) -> None:
        pass

    def set_timer(self, delay: float, callback: Callable[[], None]) -> Timer:
        return self.clock.call_later(delay, callback)

    def start_coroutine(self, coroutine: Coroutine[Any, Any, Any], ended: Ended) -> Timer:
        # Awaiting takes no time in a test: the coroutine runs to its end, which the next check of timers reports.
        result: object = None
        error: BaseException | None = None
        try:
            result = run(lambda: without_exit(coroutine), VirtualClock())
        except (Exception, CancelledError) as wrong:
            error = wrong
        return self.clock.call_later(0.0, lambda: ended(result, error))

    def act(self, act: Act) -> None:
        recorded = self._by_number[act.id] = RecordedAct(act, self.mind.complete)
        self.acts.append(recorded)
        function = self._actions.get(recorded.name)
        if function is not None:
            try:
                recorded.answer(function)
            except Exception as wrong:
                self.mistake = self.mistake or wrong

    def cancel_act(self, act_id: int) -> None:
        act = self._by_number[act_id]
        act.pending, act.cancelled = False, True

    def suspend_act(self, act_id: int) -> None:
        self._by_number[act_id].paused = True

    def resume_act(self, act_id: int) -> None:
        self._by_number[act_id].paused = False

    def send(self, message: SpeechAct) -> bool:
        if message.receiver == self._name:
            self.mind.receive(message)
            return True
        if self._others is not None and message.receiver not in self._others:
            return False
        self.sent.append(SentMessage(message))
        return True

    def agent_names(self) -> Sequence[str]:
        return (self._name, *(self._others or ()))

    def print(self, text: str) -> None:
        self.prints.append(text)

    def log(self, level: str, text: str) -> None:
        self.logs.append(f"{level}: {text}")

    def goal_lost(self) -> None:
        pass

    def out_of_memory(self) -> None:
        self.log("error", "out of memory")

    def stop_system(self, delay: float, exit_code: int) -> None:
        if delay > 0:
            self.mind.shut_down_in(delay * 1000)
            self.clock.call_later(delay, lambda: self.stop_system(0.0, exit_code))
        else:
            self.exit_code = exit_code
            self.mind.stopped = True

    def create_agent(self, name: str, source: str | None, classes: Mapping[str, str]) -> str | None:
        del classes
        self.log("info", f".create_agent({name}, {source}): this test has no other agents")
        return None

    def explain(self, question: str, agent: str) -> Mapping[str, Any]:
        raise UsageError(f"cannot answer `{question}`: this test has no recording")

    def clone_agent(self, original: str, name: str) -> str | None:
        self.log("info", f".clone({name}): this test has no other agents")
        return None

    def kill_agent(self, name: str, delay: float, killer: str) -> bool:
        if name == self._name:
            self.stop_system(delay, 0)
        return name in self.agent_names()

    def read_program(self, path: str) -> tuple[str, str]:
        return self._programs.path.include(path, str(self._file))

    def list_files(self, folder: str) -> Sequence[str]:
        return self._programs.list_files(folder, self._file.parent)

    def write_file(self, path: str, text: str) -> None:
        self.files[path] = text

    def register(self, name: str, service: str) -> None:
        self._services[service] = None

    def deregister(self, name: str, service: str) -> None:
        self._services.pop(service, None)

    def providers(self, service: str) -> Sequence[str]:
        return [self._name] if service in self._services else []

    def subscribe(self, name: str, service: str) -> None:
        pass


__tracebackhide__ = methodcaller("errisinstance", AssertionError)
"""pytest shows a failed assertion where the test makes it, not the functions of this file."""
_QUANTUM = 50
_SHOWN = 20
_LONGEST = 3600.0
"""Seconds of virtual time after which `AgentHarness.run` fails for an agent that never becomes idle."""


class AgentHarness(OpenMind):
    """An agent under test.

    Literals, goals and formulae are text of the language or data, see `jacaros.runtime.mas.embedding.given`.

    Args:
        program: program text, or the path of a file.
        name: name of the agent.
        actions: functions that answer external actions, by name; see `RecordedAct.answer`. Other actions stay pending
            until the test ends them; see `act`.
        others: names of agents that accept messages; None for any name.
        folders: folders to search for included files, in addition to that of the program.

    Attributes:
        prints: lines that the agent printed.
        logs: log lines, each as ``level: text``.
        acts: external actions started, oldest first.
        sent: messages sent, oldest first.
        files: contents of the files that the agent would have written, by path.

    Raises:
        AslError: the program has errors.
    """

    __test__ = False

    def __init__(
        self,
        program: str | Path,
        *,
        name: str = "agent",
        actions: Mapping[str, Action] | None = None,
        others: Collection[str] | None = None,
        folders: Sequence[Path] = (),
    ) -> None:
        self.name = name
        self._asked = 0
        file = program if isinstance(program, Path) else Path(f"{name}.asl")
        written = file_text(program) if isinstance(program, Path) else program
        code = PythonCode(ProjectModules(file.parent, *folders))
        programs = Programs(
            (file.parent, *folders), lambda message: self.logs.append(f"warning: {message}"), code
        )
        port = self._port = HarnessPort(name, dict(actions or {}), others, programs, file)
        self.prints, self.logs, self.files = port.prints, port.logs, port.files
        self.acts, self.sent = port.acts, port.sent
        tree, _ = load_program(str(file), written, programs.path.include, code.functions, code.actions)
        wrong = code.take_errors()
        if wrong:
            raise AslError(wrong)
        self._mind = port.mind = Mind(name, tree, port, Options(), code.actions)
        code.serve(self.mind)
        self.mind.start()

    @property
    def mind(self) -> Mind:
        """The mind of the agent, for what this class does not offer."""
        return self._mind

    @property
    def exit_code(self) -> int | None:
        """The code passed to ``.stopMAS``; None before that."""
        return self._port.exit_code

    # ---- input

    def receive(self, sender: str, performative: str, content: str) -> None:
        """Deliver a message to the agent: ``agent.receive("boss", "achieve", "clean(kitchen)")``."""
        self._asked += 1
        message = SpeechAct(
            performative, sender, self.name, lower_value(parse_term(content)), f"test{self._asked}"
        )
        self.mind.receive(message)

    def achieve(self, goal: object, /, *arguments: object, **values: object) -> PursuedGoal:
        """Give the agent a goal in a new intention; the result reports the outcome."""
        taken = read_given(goal, arguments, values)
        return PursuedGoal(taken.text, WatchedGoal(self.mind, taken.term))

    # ---- reasoning

    def step(self, cycles: int = 1) -> bool:
        """Run reasoning cycles without advancing time.

        Args:
            cycles: maximum number of cycles.

        Returns:
            Whether the agent has more to do.

        Raises:
            Exception: raised by a function that answers actions, such as a failed ``assert``; `run` raises it, too.
        """
        more = not self._stopped and self.mind.run(cycles)
        if self._port.mistake is not None:
            wrong, self._port.mistake = self._port.mistake, None
            raise wrong
        return more

    def run(self, seconds: float | None = None, cycles: int = 100_000) -> None:
        """Run reasoning cycles, and advance time to the next timer while the agent waits.

        Args:
            seconds: virtual time to run for; None to run until the agent is idle and waits for no timer.
            cycles: maximum number of reasoning cycles.

        Raises:
            AssertionError: the agent reached that number of cycles, or did not become idle within an hour of virtual time.
        """
        over: list[bool] = []
        end = self._port.clock.call_later(_LONGEST if seconds is None else seconds, lambda: over.append(True))
        while not self._stopped:
            cycles = self._reason(cycles)
            if over or self._stopped:
                break
            if seconds is None and all(timer is end for timer in self._port.clock.pending()):
                break
            self._port.clock.advance()
        end.cancel()
        if over and seconds is None:
            self._fail("not idle after an hour of virtual time: use run(seconds=...)")

    def _reason(self, cycles: int) -> int:
        while self.step(_QUANTUM):
            cycles -= _QUANTUM
            if cycles <= 0:
                self._fail("too many reasoning cycles: an endless loop?")
        return cycles

    @property
    def time(self) -> float:
        """Virtual time since the start, in seconds."""
        return self._port.clock.elapsed

    @property
    def _stopped(self) -> bool:
        return self.exit_code is not None

    # ---- state

    def act(self, pattern: str) -> RecordedAct:
        """Return the oldest pending action with that name, or matching the pattern (``driveTo(_, 2)``).

        Raises:
            AssertionError: no such action is pending.
        """
        wanted = literal(pattern)
        pending = [act for act in self.acts if act.pending]
        found = next((act for act in pending if act.name == pattern or matches(wanted, act.term)), None)
        if found is None:
            self._fail(f"no pending action {pattern}")
        return found

    # ---- assertions

    def assert_believes(self, *formulae: str) -> None:
        """Assert that each formula holds."""
        for formula in formulae:
            self._require(self.believes(formula), f"it does not believe {formula}")

    def assert_believes_not(self, *formulae: str) -> None:
        """Assert that none of the formulae holds."""
        for formula in formulae:
            self._require(not self.believes(formula), f"it believes {formula}")

    def assert_pursues(self, goal: str) -> None:
        """Assert that the agent pursues a matching goal."""
        self._require(self._pursues(goal), f"it does not pursue !{goal}")

    def assert_pursues_not(self, goal: str) -> None:
        """Assert that the agent pursues no matching goal."""
        self._require(not self._pursues(goal), f"it pursues !{goal}")

    def _pursues(self, goal: str) -> bool:
        pattern = literal(goal)
        return any(matches(pattern, each) for each, _ in goals.desires(self.mind))

    def assert_idle(self) -> None:
        """Assert that the agent has no goal and nothing to do."""
        self._require(not self.goals and self.mind.is_idle(), "it is not idle")

    def assert_achieved(self, goal: PursuedGoal) -> None:
        """Assert that a goal given by this test was achieved."""
        self._require(goal.achieved, f"not achieved: {goal}")

    def assert_failed(self, goal: PursuedGoal, reason: str | None = None) -> None:
        """Assert that a goal given by this test failed.

        Args:
            goal: returned by `achieve`.
            reason: an annotation of the failure, such as ``error(no_relevant)`` or ``env_failure_reason(blocked(wall))``;
                None for any.
        """
        self._require(goal.failed, f"it did not fail: {goal}")
        if reason is not None and not any(matches(literal(reason), each) for each in goal.reasons):
            self._fail(f"it failed for another reason than {reason}: {goal}")

    def assert_printed(self, part: str) -> None:
        """Assert that a printed line contains *part*."""
        self._require(any(part in line for line in self.prints), f"it did not print {part!r}")

    def assert_printed_not(self, part: str) -> None:
        """Assert that no printed line contains *part*."""
        self._require(not any(part in line for line in self.prints), f"it printed {part!r}")

    def assert_did(self, *actions: str) -> None:
        """Assert that matching actions were started in this order, possibly with others between them."""
        begun = iter(self.acts)
        for action in actions:
            pattern = literal(action)
            if not any(matches(pattern, act.term) for act in begun):
                order = " in this order" if len(actions) > 1 else ""
                self._fail(f"it did not do {', '.join(actions)}{order}")

    def assert_did_not(self, *actions: str) -> None:
        """Assert that no matching action was started."""
        for action in actions:
            pattern = literal(action)
            self._require(not any(matches(pattern, act.term) for act in self.acts), f"it did {action}")

    def assert_sent(self, receiver: str, performative: str, content: str) -> None:
        """Assert that a message was sent whose content matches."""
        if not self._has_sent(receiver, performative, content):
            self._fail(f"it did not send {performative} {content} to {receiver}")

    def assert_sent_not(self, receiver: str, performative: str, content: str) -> None:
        """Assert that no such message was sent."""
        if self._has_sent(receiver, performative, content):
            self._fail(f"it sent {performative} {content} to {receiver}")

    def _has_sent(self, receiver: str, performative: str, content: str) -> bool:
        pattern = lower_value(parse_term(content))
        return any(
            (message.receiver, message.performative) == (receiver, performative)
            and matches(pattern, message.term)
            for message in self.sent
        )

    def __str__(self) -> str:
        """Return the visible state of the agent as text."""
        parts: dict[str, Sequence[str]] = {
            "beliefs": self.beliefs,
            "goals": [f"!{goal}" for goal in self.goals],
            "acts": [f"{act}{' (pending)' if act.pending else ''}" for act in self.acts],
            "sent": [repr(message) for message in self.sent],
            "printed": self.prints,
            "logged": self.logs,
        }
        lines = [f"agent {self.name} at {self.time:g} s"]
        for title, shown in parts.items():
            if shown:
                rest = [f"... and {len(shown) - _SHOWN} before"] if len(shown) > _SHOWN else []
                lines += [f"  {title}:", *(f"    {line}" for line in (*rest, *shown[-_SHOWN:]))]
        return "\n".join(lines)

    def _require(self, holds: bool, message: str) -> None:
        if not holds:
            self._fail(message)

    def _fail(self, message: str) -> NoReturn:
        raise AssertionError(f"{message}\n{self}")
