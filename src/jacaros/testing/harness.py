"""One agent in the hands of a Python test: given beliefs, percepts, messages and goals, made to reason, and looked at.

No environment, no other agents, no waiting: the agent's actions and messages are recorded, and its time is virtual and
moves only when the test lets it::

    def test_a_low_battery_sends_the_robot_to_the_dock() -> None:
        agent = AgentHarness(Path("robot.asl"))
        agent.perceive("battery(15)")
        agent.run()
        agent.assert_did("driveTo(1, 1)")
        agent.act("driveTo").fail("blocked")
        agent.run()
        agent.assert_printed("I need help")
"""

from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import NoReturn

import jacaros.bdi.actions.standard  # noqa: F401 - fills the table of internal actions
from jacaros.asl.diagnostics import AslError
from jacaros.asl.loader import load_program, parse_term
from jacaros.asl.lowering import lower_value
from jacaros.bdi.mind import Mind
from jacaros.bdi.rules import goals
from jacaros.bdi.rules.watched import WatchedGoal
from jacaros.bdi.state.options import Options
from jacaros.bdi.state.speech_act import SpeechAct
from jacaros.mas.embedding.running_agent import PursuedGoal
from jacaros.mas.open_mind import OpenMind, literal
from jacaros.mas.programs import Programs
from jacaros.mas.python_code import PythonCode
from jacaros.project_modules import ProjectModules
from jacaros.terms.substitution import rename
from jacaros.terms.unifier import Trail, undo, unify
from jacaros.terms.values import Term
from jacaros.testing.port import HarnessPort
from jacaros.testing.recorded import Action, RecordedAct
from jacaros.text_files import file_text

_QUANTUM = 50
_SHOWN = 20
_LONGEST = 3600.0
"""Seconds of virtual time after which `AgentHarness.run` gives up on an agent that never gets idle."""


class AgentHarness(OpenMind):
    """An agent under test.

    Literals, goals and formulae are given as text, in the syntax of the language.

    Args:
        program: the program as text, or the path of a file.
        name: of the agent.
        actions: functions that answer external actions, by name, see `RecordedAct.answer`.  Actions without one stay
            pending until the test ends them, see `act`.
        others: names of the agents that can be sent messages; all names can if it is None.
        folders: where included files are looked for, beside the folder of the program.
        seed: of the agent's random numbers.

    Attributes:
        prints: what the agent has printed, line by line.
        logs: what was told to people, each as ``level: text``.
        acts: the external actions begun, oldest first.
        sent: the messages sent, oldest first.
        files: texts of the files that it would have written, by path.

    Raises:
        AslError: the program is wrong.
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
        seed: int = 0,
    ) -> None:
        self.name = name
        self._asked = 0
        file = program if isinstance(program, Path) else Path(f"{name}.asl")
        written = file_text(program) if isinstance(program, Path) else program
        code = PythonCode(ProjectModules(file.parent, *folders))
        programs = Programs((file.parent, *folders), lambda told: self.logs.append(f"warning: {told}"), code)
        port = self._port = HarnessPort(name, dict(actions or {}), others, seed, programs, file)
        self.prints, self.logs, self.files = port.prints, port.logs, port.files
        self.acts, self.sent = port.acts, port.sent
        tree, _ = load_program(str(file), written, programs.include, code.functions, code.actions)
        wrong = code.take_errors()
        if wrong:
            raise AslError(wrong)
        self._mind = port.mind = Mind(name, tree, port, Options(), code.actions)
        code.serve(self.mind)
        self.mind.start()

    @property
    def mind(self) -> Mind:
        """The agent itself, for what this class does not offer."""
        return self._mind

    @property
    def exit_code(self) -> int | None:
        """The code of ``.stopMAS``; None while the program has not called it."""
        return self._port.exit_code

    # ---- giving

    def receive(self, sender: str, performative: str, content: str) -> None:
        """Let the agent receive a message: ``agent.receive("boss", "achieve", "clean(kitchen)")``."""
        self._asked += 1
        message = SpeechAct(
            performative, sender, self.name, lower_value(parse_term(content)), f"test{self._asked}"
        )
        self.mind.receive(message)

    def achieve(self, goal: str) -> PursuedGoal:
        """Give the agent a goal, with an intention of its own; tells later what became of it."""
        return PursuedGoal(goal, WatchedGoal(self.mind, literal(goal)))

    # ---- letting it reason

    def step(self, cycles: int = 1) -> bool:
        """Let it make at most so many reasoning cycles; no time passes.  Whether there is more to do.

        What a function that answers actions raises, such as a failed ``assert``, is raised here and by `run`.
        """
        more = not self._stopped and self.mind.run(cycles)
        if self._port.mistake is not None:
            wrong, self._port.mistake = self._port.mistake, None
            raise wrong
        return more

    def run(self, seconds: float | None = None, cycles: int = 100_000) -> None:
        """Let it reason.

        Args:
            seconds: for so long in virtual time; without, until it has nothing to do and waits for no time to pass.
            cycles: at most so many reasoning cycles.

        Raises:
            AssertionError: it made that many cycles, or went on for an hour of virtual time.
        """
        __tracebackhide__ = True
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
            self._complain("it went on for an hour: use run(seconds=...)")

    def _reason(self, cycles: int) -> int:
        __tracebackhide__ = True
        while self.step(_QUANTUM):
            cycles -= _QUANTUM
            if cycles <= 0:
                self._complain("it made very many reasoning cycles without an end: an endless loop?")
        return cycles

    @property
    def time(self) -> float:
        """Seconds of virtual time since the beginning."""
        return self._port.clock.elapsed

    @property
    def _stopped(self) -> bool:
        return self.exit_code is not None

    # ---- asking

    def act(self, pattern: str) -> RecordedAct:
        """The oldest pending act of that name, or that matches the pattern (``driveTo(_, 2)``).

        Raises:
            AssertionError: there is none.
        """
        __tracebackhide__ = True
        wanted = literal(pattern)
        pending = [act for act in self.acts if act.pending]
        found = next((act for act in pending if act.name == pattern or _matches(wanted, act.term)), None)
        if found is None:
            self._complain(f"no act {pattern} is pending")
        return found

    # ---- asserting

    def assert_believes(self, *formulae: str) -> None:
        """Assert that each formula holds."""
        __tracebackhide__ = True
        for formula in formulae:
            self._require(self.believes(formula), f"it does not believe {formula}")

    def assert_believes_not(self, *formulae: str) -> None:
        """Assert that none of the formulae holds."""
        __tracebackhide__ = True
        for formula in formulae:
            self._require(not self.believes(formula), f"it believes {formula}")

    def assert_pursues(self, goal: str) -> None:
        """Assert that a goal that matches is pursued."""
        __tracebackhide__ = True
        self._require(self._pursues(goal), f"it does not pursue !{goal}")

    def assert_pursues_not(self, goal: str) -> None:
        """Assert that no goal that matches is pursued."""
        __tracebackhide__ = True
        self._require(not self._pursues(goal), f"it pursues !{goal}")

    def _pursues(self, goal: str) -> bool:
        pattern = literal(goal)
        return any(_matches(pattern, each) for each, _ in goals.desires(self.mind))

    def assert_idle(self) -> None:
        """Assert that it has no goal and nothing to do."""
        __tracebackhide__ = True
        self._require(not self.goals and self.mind.is_idle(), "it is not idle")

    def assert_achieved(self, goal: PursuedGoal) -> None:
        """Assert that a goal of this test was achieved."""
        __tracebackhide__ = True
        self._require(goal.achieved, f"not achieved: {goal}")

    def assert_failed(self, goal: PursuedGoal, reason: str | None = None) -> None:
        """Assert that a goal of this test failed; with a reason, that it is among those of the failure.

        The reasons are terms such as ``error(no_relevant)`` and ``env_failure_reason(blocked(wall))``.
        """
        __tracebackhide__ = True
        self._require(goal.failed, f"it did not fail: {goal}")
        if reason is not None and not any(_matches(literal(reason), each) for each in goal.reasons):
            self._complain(f"it failed for another reason than {reason}: {goal}")

    def assert_printed(self, part: str) -> None:
        """Assert that a printed line has this in it."""
        __tracebackhide__ = True
        self._require(any(part in line for line in self.prints), f"it did not print {part!r}")

    def assert_printed_not(self, part: str) -> None:
        """Assert that no printed line has this in it."""
        __tracebackhide__ = True
        self._require(not any(part in line for line in self.prints), f"it printed {part!r}")

    def assert_did(self, *actions: str) -> None:
        """Assert that actions that match were begun, in this order; others may have come between."""
        __tracebackhide__ = True
        begun = iter(self.acts)
        for action in actions:
            pattern = literal(action)
            if not any(_matches(pattern, act.term) for act in begun):
                order = " in this order" if len(actions) > 1 else ""
                self._complain(f"it did not do {', '.join(actions)}{order}")

    def assert_did_not(self, *actions: str) -> None:
        """Assert that no action that matches one of these was begun."""
        __tracebackhide__ = True
        for action in actions:
            pattern = literal(action)
            self._require(not any(_matches(pattern, act.term) for act in self.acts), f"it did {action}")

    def assert_sent(self, receiver: str, performative: str, content: str) -> None:
        """Assert that such a message was sent; the content is a pattern."""
        __tracebackhide__ = True
        if not self._has_sent(receiver, performative, content):
            self._complain(f"it did not send {performative} {content} to {receiver}")

    def assert_sent_not(self, receiver: str, performative: str, content: str) -> None:
        """Assert that no such message was sent."""
        __tracebackhide__ = True
        if self._has_sent(receiver, performative, content):
            self._complain(f"it sent {performative} {content} to {receiver}")

    def _has_sent(self, receiver: str, performative: str, content: str) -> bool:
        pattern = lower_value(parse_term(content))
        return any(
            (message.receiver, message.performative) == (receiver, performative)
            and _matches(pattern, message.term)
            for message in self.sent
        )

    def __str__(self) -> str:
        """All that can be seen of the agent, for people."""
        parts = {
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

    def _require(self, holds: bool, told: str) -> None:
        __tracebackhide__ = True
        if not holds:
            self._complain(told)

    def _complain(self, told: str) -> NoReturn:
        __tracebackhide__ = True
        raise AssertionError(f"{told}\n{self}")


def _matches(pattern: Term, term: Term) -> bool:
    """Whether a pattern unifies with a term; annotations count only where the pattern has some."""
    trail = Trail()
    found = unify(pattern, rename(term), trail)
    undo(trail, 0)
    return found
