"""The internal actions behind the assertion goals of ``$jacaros/test_assert.asl``.

An assertion that fails is reported to the test of the agent, or logged outside of a test. The plan continues, as in Jason,
so one test may report several failures. Actions that need a test raise `ActionError` outside of one.
"""

import operator
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, NamedTuple

from jacaros.agents.language.diagnostics import Span
from jacaros.agents.mind.actions.internal_action import ActionError, InternalAction, WrongArguments, members
from jacaros.agents.mind.rules.context import Context
from jacaros.agents.mind.rules.failure_reason import place_of_call
from jacaros.agents.mind.state.act import Act, Completion
from jacaros.agents.mind.state.intention import GOAL, PLAN
from jacaros.agents.terms.substitution import equal, free_variables, rename, resolve
from jacaros.agents.terms.text import display, text
from jacaros.agents.terms.unifier import Trail, undo, unify
from jacaros.agents.terms.values import (
    ACTION,
    FALSE,
    TRUE,
    String,
    Term,
    atom,
    functor,
    functor_of,
    is_list,
    list_items,
)
from jacaros.runtime.errors import InternalError

_STOP: Final = ".stopMAS"
ERROR_MSG = functor("error_msg", 1)
REASON = functor("env_failure_reason", 1)

Complete = Callable[[int, Completion], None]
Later = Callable[[float, Callable[[], None]], object]


def matches(pattern: Term, term: Term) -> bool:
    """Return whether a pattern unifies with a term; annotations count only if the pattern has some."""
    trail = Trail()
    found = unify(pattern, rename(term), trail)
    undo(trail, 0)
    return found


def failed(reason: Term, message: Term = None) -> Completion:
    """Return the completion of a failed action, in the form that environments use."""
    message = String(text(reason)) if message is None else String(message)
    return Completion(False, (), ((ERROR_MSG, message), (REASON, reason)))


# Fake actions answer external actions instead of an environment.


class _Fake(NamedTuple):
    pattern: Term
    outcome: Term


class Fakes:
    """The fake actions of one agent, and all actions that it has started.

    Args:
        complete: reports the end of an action to the agent.
        later: calls a function after a number of seconds on the run's clock.

    Attributes:
        acts: every action started, fake or not, oldest first, with the outputs returned by a fake.
    """

    def __init__(self, complete: Complete, later: Later) -> None:
        self._complete = complete
        self._later = later
        self._fakes: list[_Fake] = []
        self.acts: list[Term] = []
        self._fakes_stop = False

    def add(self, pattern: Term, outcome: Term = None) -> None:
        """Answer actions that match *pattern*; the fake added last wins.

        Where the action has an unbound variable, the value in the pattern becomes its output.

        Args:
            pattern: an atom or structure; ``.stopMAS`` matches all its forms.
            outcome: ``done`` (the default), ``after(Ms)``, ``failed(Reason)``, ``failed(Reason, Message)`` or ``never``.

        Raises:
            ValueError: the outcome or the pattern is invalid.
        """
        outcome = atom("done") if outcome is None else resolve(outcome)
        if not _is_outcome(outcome):
            raise ValueError(
                f"invalid outcome {text(outcome)}: expected done, after(Ms), failed(Reason), failed(Reason, Message) or "
                "never"
            )
        symbol = functor_of(pattern)
        if symbol is None or (symbol.name[:1] == "." and symbol.name != _STOP):
            raise ValueError(f"{text(pattern)} is not an external action")
        if symbol.name == _STOP:
            self._fakes_stop = True
            return
        self._fakes.append(_Fake(rename(pattern), outcome))

    def begin(self, act: Act) -> bool:
        """Answer an action; return False if no fake matches."""
        term = (act.functor, *act.arguments) if act.arguments else act.functor
        variables = free_variables(term)
        trail = Trail()
        for fake in reversed(self._fakes):
            if not unify(rename(fake.pattern), term, trail):
                undo(trail, 0)
                continue
            values = [(variable, resolve(variable)) for variable in variables]
            self.acts.append(resolve(term))
            undo(trail, 0)
            self._answer(act.id, fake.outcome, tuple((v, value) for v, value in values if value is not v))
            return True
        self.acts.append(term)
        return False

    def stop(self, delay: float, exit_code: int) -> bool:
        """Record a call of ``.stopMAS``; return False if it is not faked and must end the run."""
        if self._fakes_stop:
            given = [delay * 1000.0, float(exit_code)] if exit_code else [delay * 1000.0] if delay else []
            symbol = functor(_STOP, len(given), kind=ACTION)
            self.acts.append((symbol, *given) if given else symbol)
        return self._fakes_stop

    def _answer(self, number: int, outcome: Term, outputs: tuple[tuple[Term, Term], ...]) -> None:
        done = Completion(True, outputs)
        if outcome is atom("done"):
            self._complete(number, done)
        elif outcome is not atom("never"):
            if outcome[0].name == "after":
                self._later(outcome[1] / 1000.0, lambda: self._complete(number, done))
            else:
                self._complete(number, failed(*outcome[1:]))


def _is_outcome(term: Term) -> bool:
    symbol = functor_of(term)
    if symbol is None:
        return False
    if (symbol.name, symbol.arity) == ("after", 1):
        return isinstance(term[1], float)
    if (symbol.name, symbol.arity) == ("failed", 2):
        return isinstance(term[2], str)
    return (symbol.name, symbol.arity) in {("done", 0), ("never", 0), ("failed", 1)}


# A test's view of one agent, and the path from assertions of the agent to the test.


@dataclass(frozen=True, slots=True)
class Assertion:
    """An assertion evaluated by a program.

    Attributes:
        name: the assertion goal, such as ``assert_equals``.
        passed: whether it held.
        expected, actual: for the report; may be empty.
        span: place in the program; None if unknown.
    """

    name: str
    passed: bool
    expected: str
    actual: str
    span: Span | None

    def text(self) -> str:
        """Return the assertion in one line, without its place."""
        if self.passed:
            return f"{self.name} passed"
        text = f"expected {self.expected}" if self.expected else ""
        if self.actual:
            text += f"{', but ' if text else ''}{self.actual}"
        return f"{self.name} failed: {text}"


@dataclass(frozen=True, slots=True)
class Probe:
    """A test that observes one agent.

    Attributes:
        prints: lines that the agent printed, oldest first.
    """

    fakes: Fakes
    asserted: Callable[[Assertion], None]
    prints: Callable[[], Sequence[str]]


class Asserting:
    """A call of an internal action behind an assertion goal.

    Args:
        probe: the test of the agent; None to log failed assertions.
    """

    def __init__(self, ctx: Context, probe: Probe | None) -> None:
        self.ctx = ctx
        self._probe = probe

    def report(self, passed: bool, expected: str, actual: str = "") -> None:
        """Report the assertion made by the goal whose plan makes this call."""
        assertion = Assertion(self._goal(), passed, _readable(expected), _readable(actual), self._place())
        if self._probe is not None:
            self._probe.asserted(assertion)
            return
        where = f"{assertion.span.file.name}:{assertion.span.line}: " if assertion.span is not None else ""
        self.ctx.architecture.log("info" if passed else "error", f"{where}{assertion.text()}")

    def probe(self, what: str) -> Probe:
        """Return the test of this agent; *what* names the calling assertion.

        Raises:
            ActionError: the agent is not in a test.
        """
        if self._probe is None:
            raise ActionError(f"{what} works only in tests; run them with `jacaros test`")
        return self._probe

    def _goal(self) -> str:
        if self.ctx.intention is None:
            return "assertion"
        name: str = self.ctx.intention.frames[-1][GOAL][0].functor.name
        return name

    def _place(self) -> Span | None:
        """Return where the assertion goal is called; None without a caller, as for ``!!assert_true(F)``."""
        intention = self.ctx.intention
        if intention is None:
            return None
        own = len(intention.frames) - 1
        if intention.frames[own][GOAL][0].failing and intention.handlers:
            # A handler is above the frame of the failed goal.
            own = intention.handlers[-1]
        if own == 0 or not intention.frames[own - 1][PLAN].steps:
            return None
        return place_of_call(intention.frames[own - 1], intention.frames[-1][GOAL][0].functor)


def _readable(shown: str) -> str:
    """Return text with anonymous variables as ``_``, without their numbers."""
    return re.sub(r"\b_\d+\b", "_", shown)


_SHOWN = 8
"""Number of beliefs or lines shown for a failed assertion."""

_Function = Callable[..., None]
_declared: dict[str, tuple[_Function, tuple[object, ...], int | tuple[int, int]]] = {}


def _action(name: str, arity: int | tuple[int, int], *given: object) -> Callable[[_Function], _Function]:
    """Declare a function as the internal action ``jacaros.NAME``; *given* are passed before the arguments of a call."""

    def declare(function: _Function) -> _Function:
        _declared[f"jacaros.{name}"] = (function, given, arity)
        return function

    return declare


def actions(probes: Mapping[str, Probe]) -> dict[str, InternalAction]:
    """Return the internal actions of tests, for the agents of one run.

    Args:
        probes: the test that observes each agent, by agent name; looked up at each call.
    """

    def bound(function: _Function, given: tuple[object, ...]) -> Callable[..., None]:
        def run(ctx: Context, *arguments: Term) -> None:
            function(Asserting(ctx, probes.get(ctx.agent.name)), *given, *arguments)

        return run

    return {
        name: InternalAction(name, bound(function, given), arity=arity)
        for name, (function, given, arity) in _declared.items()
    }


def _holds(ctx: Context, formula: Term) -> bool:
    """Return whether a formula holds, without binding its variables."""
    mark = len(ctx.trail)
    try:
        return ctx.succeeds(formula)
    finally:
        undo(ctx.trail, mark)


def _is_in(item: Term, items: Iterable[Term]) -> bool:
    return any(matches(item, candidate) for candidate in items)


def _same(expected: Term, actual: Term) -> bool:
    """Compare as ``==``, but for lists ignore the order of elements, as Jason does."""
    if is_list(expected) and is_list(actual):
        left, right = list(list_items(expected)), list(list_items(actual))
        return all(_is_in(item, right) for item in left) and all(_is_in(item, left) for item in right)
    return equal(expected, actual)


def _believed(ctx: Context, formula: Term) -> str:
    """Return the beliefs of the predicate of a formula, for a message."""
    symbol = functor_of(formula)
    if symbol is None or symbol.kind or symbol in (TRUE, FALSE):
        return "it does not hold"
    held = [text(literal) for literal in ctx.agent.beliefs.literals() if _alike(functor_of(literal), symbol)]
    if not held:
        return f"no belief {symbol!r}"
    more = f" and {len(held) - _SHOWN} more" if len(held) > _SHOWN else ""
    return f"the agent believes {', '.join(held[:_SHOWN])}{more}"


def _alike(one: Term, other: Term) -> bool:
    return one is not None and (one.name, one.arity) == (other.name, other.arity)


@_action("assert_equals", (2, 3))
def assert_equals(call: Asserting, expected: Term, actual: Term, tolerance: Term = None) -> None:
    """``jacaros.assert_equals(Expected, Actual [,Tolerance])``; see `_same` for what is equal."""
    if tolerance is None:
        call.report(_same(expected, actual), text(expected), f"was {text(actual)}")
        return
    numbers = (expected, actual, tolerance)
    passed = (
        all(isinstance(n, float) for n in numbers) and expected - tolerance <= actual <= expected + tolerance
    )
    call.report(passed, f"{text(expected)} +/- {text(tolerance)}", f"was {text(actual)}")


@_action("assert_not_equals", 2)
def assert_not_equals(call: Asserting, unwanted: Term, actual: Term) -> None:
    call.report(not _same(unwanted, actual), f"anything but {text(unwanted)}", f"was {text(actual)}")


@_action("assert_true", 1, True)
@_action("assert_false", 1, False)
def _assert_that(call: Asserting, wanted: bool, formula: Term) -> None:
    """Assert that a formula holds, or does not hold, now."""
    expected = text(formula) if wanted else f"not {text(formula)}"
    try:
        passed = _holds(call.ctx, formula) is wanted
    except InternalError:
        raise
    except Exception as fault:
        # Report the failure where the test makes the assertion.
        call.report(False, expected, f"cannot evaluate it: {fault or type(fault).__name__}")
        return
    found = "" if passed else _believed(call.ctx, formula) if wanted else "it holds"
    call.report(passed, expected, found)


@_action("assert_contains", 2, True)
@_action("assert_not_contains", 2, False)
def _assert_contents(call: Asserting, wanted: bool, collection: Term, item: Term) -> None:
    """Assert that an element of a list, set or queue unifies with *item*, or that no element does."""
    try:
        items: list[Term] | None = members(collection, "the collection")
    except WrongArguments:
        items = None
    passed = items is not None and _is_in(item, items) is wanted
    actual = "is not a list or set" if items is None else "does not contain it" if wanted else "contains it"
    expected = text(item) if wanted else f"no {text(item)}"
    call.report(passed, expected, f"{text(collection)} {actual}")


@_action("assert_greater_than", 2, operator.gt, "more than {}")
@_action("assert_greater_than_equals", 2, operator.ge, "{} or more")
def _assert_greater(
    call: Asserting, compare: Callable[[Term, Term], bool], expected: str, left: Term, right: Term
) -> None:
    """Assert that two numbers compare as declared."""
    passed = isinstance(left, float) and isinstance(right, float) and compare(left, right)
    call.report(passed, expected.format(text(right)), f"was {text(left)}")


@_action("assert_between", 3)
def assert_between(call: Asserting, value: Term, least: Term, most: Term) -> None:
    """``jacaros.assert_between(X, Least, Most)``: both bounds are included."""
    passed = all(isinstance(n, float) for n in (value, least, most)) and least <= value <= most
    call.report(passed, f"{text(least)} to {text(most)}", f"was {text(value)}")


@_action("force_pass", 0)
def force_pass(call: Asserting) -> None:
    """``jacaros.force_pass``: an assertion that always holds."""
    call.report(True, "")


@_action("force_failure", 1)
def force_failure(call: Asserting, message: Term) -> None:
    """``jacaros.force_failure(Message)``: an assertion that always fails."""
    shown = str(message) if isinstance(message, str) else text(message)
    call.report(False, "", shown)


@_action("assert_fail", 2)
def assert_fail(call: Asserting, goal: Term, failed: Term) -> None:
    """``jacaros.assert_fail(Goal, failed|achieved)``: the outcome of a goal that should fail."""
    passed = text(failed) == "failed"
    call.report(passed, f"!{text(goal)} to fail", "" if passed else "it was achieved")


@_action("fake", (1, 2))
def fake(call: Asserting, action: Term, outcome: Term = None) -> None:
    """``jacaros.fake(Action [,Outcome])``: answer an external action instead of the environment."""
    try:
        call.probe("fake_action").fakes.add(action, outcome)
    except ValueError as wrong:
        raise ActionError(str(wrong)) from None


@_action("assert_did", (1, 2))
def assert_did(call: Asserting, action: Term, times: Term = None) -> None:
    """``jacaros.assert_did(Action [,Times])``: the agent has started a matching external action, *Times* times if given."""
    acts = call.probe("assert_did").fakes.acts
    actual = f"it did {', '.join(map(text, acts))}" if acts else "it did nothing"
    if times is None:
        call.report(_is_in(action, acts), text(action), actual)
    else:
        count = sum(_is_in(action, [act]) for act in acts)
        call.report(float(count) == times, f"{text(times)} times {text(action)}", actual)


@_action("assert_printed", 1)
def assert_printed(call: Asserting, part: Term) -> None:
    """``jacaros.assert_printed(Text)``: a line that the agent has printed contains *Text*."""
    shown = display(part)
    prints = call.probe("assert_printed").prints()
    actual = (
        f"it printed {', '.join(repr(line) for line in prints[-_SHOWN:])}" if prints else "it printed nothing"
    )
    call.report(any(shown in line for line in prints), f"output containing {shown!r}", actual)


@_action("assert_not_did", 1)
def assert_not_did(call: Asserting, action: Term) -> None:
    """``jacaros.assert_not_did(Action)``: the agent has started no matching external action."""
    acts = call.probe("assert_not_did").fakes.acts
    call.report(not _is_in(action, acts), f"no {text(action)}", f"it did {', '.join(map(text, acts))}")


UNTESTED: Final = actions(MappingProxyType({}))
"""The internal actions for programs that run outside of a test: failed assertions are logged."""
