"""The internal actions behind ``$jacaros/test_assert.asl``: what the assertion goals of tests do.

An assertion that fails is told to whoever tests the agent, else to people, and the plan goes on: as on Jason, one test may
tell several failures.
"""

import re
from collections.abc import Iterable

from jacaros.asl.source import Span
from jacaros.bdi.actions.internal_action import ActionError, internal_action
from jacaros.bdi.explaining.failure_reason import place_of_call
from jacaros.bdi.rules.context import Context
from jacaros.bdi.state.intention import GOAL, PLAN
from jacaros.bdi.state.probe import Assertion, Probe
from jacaros.errors import InternalError
from jacaros.terms.collections import QueueValue, SetValue
from jacaros.terms.substitution import equal
from jacaros.terms.text import display, text
from jacaros.terms.unifier import Trail, undo, unify
from jacaros.terms.values import FALSE, TRUE, Term, functor_of, is_list, list_items

_SHOWN = 8
"""Number of beliefs that are shown beside a formula that does not hold."""


def tell_assertion(ctx: Context, passed: bool, expected: str, actual: str = "") -> None:
    """Report the assertion made by the goal whose plan calls this."""
    assertion = Assertion(_goal_name(ctx), passed, _readable(expected), _readable(actual), _place(ctx))
    probe: Probe | None = ctx.agent.probe
    if probe is not None:
        probe.asserted(assertion)
        return
    where = f"{assertion.span.file.name}:{assertion.span.line}: " if assertion.span is not None else ""
    ctx.architecture.log("info" if passed else "error", f"{where}{assertion.text()}")


def _readable(shown: str) -> str:
    """Unnamed variables as they are written, without their numbers."""
    return re.sub(r"\b_\d+\b", "_", shown)


def _place(ctx: Context) -> Span | None:
    """Where the assertion goal is called; None when it has no caller, as with ``!!assert_true(F)``."""
    intention = ctx.intention
    if intention is None:
        return None
    own = len(intention.frames) - 1
    if intention.frames[own][GOAL][0].failing and intention.handlers:
        # A handler stands above the frame of the goal that failed.
        own = intention.handlers[-1]
    if own == 0 or not intention.frames[own - 1][PLAN].steps:
        return None
    return place_of_call(intention.frames[own - 1], intention.frames[-1][GOAL][0].functor)


def _goal_name(ctx: Context) -> str:
    if ctx.intention is None:
        return "assertion"
    name: str = ctx.intention.frames[-1][GOAL][0].functor.name
    return name


def probe_of(ctx: Context, what: str) -> Probe:
    """Who tests this agent; *what* asks.

    Raises:
        ActionError: nobody does.
    """
    probe: Probe | None = ctx.agent.probe
    if probe is None:
        raise ActionError(f"{what} is for tests: run them with jacaros test")
    return probe


def _holds(ctx: Context, formula: Term) -> bool:
    """Whether a formula holds; nothing stays bound."""
    mark = len(ctx.trail)
    try:
        return ctx.succeeds(formula)
    finally:
        undo(ctx.trail, mark)


def _fault(fault: Exception) -> str:
    """What is told of a formula that cannot be evaluated: an assertion about it fails, where the test makes it."""
    return f"it cannot be evaluated: {fault or type(fault).__name__}"


def _is_in(item: Term, items: Iterable[Term]) -> bool:
    trail = Trail()
    for candidate in items:
        if unify(item, candidate, trail):
            undo(trail, 0)
            return True
        undo(trail, 0)
    return False


def _same(expected: Term, actual: Term) -> bool:
    """Equality of assertions: as ``==``, but lists need only have the same elements, in any order, as on Jason."""
    if is_list(expected) and is_list(actual):
        left, right = list(list_items(expected)), list(list_items(actual))
        return all(_is_in(item, right) for item in left) and all(_is_in(item, left) for item in right)
    return equal(expected, actual)


def _items(collection: Term) -> list[Term] | None:
    """The elements of a list, set or queue; None for other terms."""
    if is_list(collection):
        return list(list_items(collection))
    if isinstance(collection, (SetValue, QueueValue)):
        return list(collection)
    return None


def _believed(ctx: Context, formula: Term) -> str:
    """What is believed of the predicate of a formula, for people."""
    symbol = functor_of(formula)
    if symbol is None or symbol.kind or symbol in (TRUE, FALSE):
        return "it does not hold"
    held = [text(literal) for literal in ctx.agent.beliefs.literals() if _alike(functor_of(literal), symbol)]
    if not held:
        return f"there is no belief {symbol!r}"
    more = f" and {len(held) - _SHOWN} more" if len(held) > _SHOWN else ""
    return f"believed is {', '.join(held[:_SHOWN])}{more}"


def _alike(one: Term, other: Term) -> bool:
    return one is not None and (one.name, one.arity) == (other.name, other.arity)


@internal_action("jacaros.assert_equals", arity=(2, 3))
def assert_equals(ctx: Context, expected: Term, actual: Term, tolerance: Term = None) -> None:
    """``jacaros.assert_equals(Expected, Actual [,Tolerance])``; see `_same` for what is equal."""
    if tolerance is None:
        tell_assertion(ctx, _same(expected, actual), text(expected), f"was {text(actual)}")
        return
    numbers = (expected, actual, tolerance)
    passed = (
        all(isinstance(n, float) for n in numbers) and expected - tolerance <= actual <= expected + tolerance
    )
    tell_assertion(ctx, passed, f"{text(expected)} +/- {text(tolerance)}", f"was {text(actual)}")


@internal_action("jacaros.assert_not_equals", arity=2)
def assert_not_equals(ctx: Context, unwanted: Term, actual: Term) -> None:
    """``jacaros.assert_not_equals(Unwanted, Actual)``."""
    tell_assertion(ctx, not _same(unwanted, actual), f"anything but {text(unwanted)}", f"was {text(actual)}")


@internal_action("jacaros.assert_true", arity=1)
def assert_true(ctx: Context, formula: Term) -> None:
    """``jacaros.assert_true(Formula)``: it holds now."""
    try:
        passed = _holds(ctx, formula)
    except InternalError:
        raise
    except Exception as fault:
        tell_assertion(ctx, False, text(formula), _fault(fault))
        return
    tell_assertion(ctx, passed, text(formula), "" if passed else _believed(ctx, formula))


@internal_action("jacaros.assert_false", arity=1)
def assert_false(ctx: Context, formula: Term) -> None:
    """``jacaros.assert_false(Formula)``: it does not hold now."""
    try:
        passed = not _holds(ctx, formula)
    except InternalError:
        raise
    except Exception as fault:
        tell_assertion(ctx, False, f"not {text(formula)}", _fault(fault))
        return
    tell_assertion(ctx, passed, f"not {text(formula)}", "" if passed else "it holds")


@internal_action("jacaros.assert_contains", arity=2)
def assert_contains(ctx: Context, collection: Term, item: Term) -> None:
    """``jacaros.assert_contains(Collection, Item)``: an element of the list or set unifies with *item*."""
    items = _items(collection)
    told = "is no list or set" if items is None else "does not contain it"
    tell_assertion(ctx, items is not None and _is_in(item, items), text(item), f"{text(collection)} {told}")


@internal_action("jacaros.assert_not_contains", arity=2)
def assert_not_contains(ctx: Context, collection: Term, item: Term) -> None:
    """``jacaros.assert_not_contains(Collection, Item)``: no element of the list or set unifies with *item*."""
    items = _items(collection)
    told = "is no list or set" if items is None else "contains it"
    tell_assertion(
        ctx, items is not None and not _is_in(item, items), f"no {text(item)}", f"{text(collection)} {told}"
    )


@internal_action("jacaros.assert_greater_than", arity=2)
def assert_greater_than(ctx: Context, left: Term, right: Term) -> None:
    """``jacaros.assert_greater_than(A, B)``: numbers, A > B."""
    passed = isinstance(left, float) and isinstance(right, float) and left > right
    tell_assertion(ctx, passed, f"more than {text(right)}", f"was {text(left)}")


@internal_action("jacaros.assert_greater_than_equals", arity=2)
def assert_greater_than_equals(ctx: Context, left: Term, right: Term) -> None:
    """``jacaros.assert_greater_than_equals(A, B)``: numbers, A >= B."""
    passed = isinstance(left, float) and isinstance(right, float) and left >= right
    tell_assertion(ctx, passed, f"{text(right)} or more", f"was {text(left)}")


@internal_action("jacaros.assert_between", arity=3)
def assert_between(ctx: Context, value: Term, least: Term, most: Term) -> None:
    """``jacaros.assert_between(X, Least, Most)``: numbers, both bounds included."""
    passed = all(isinstance(n, float) for n in (value, least, most)) and least <= value <= most
    tell_assertion(ctx, passed, f"{text(least)} to {text(most)}", f"was {text(value)}")


@internal_action("jacaros.force_pass", arity=0)
def force_pass(ctx: Context) -> None:
    """``jacaros.force_pass``: an assertion that holds."""
    tell_assertion(ctx, True, "")


@internal_action("jacaros.force_failure", arity=1)
def force_failure(ctx: Context, message: Term) -> None:
    """``jacaros.force_failure(Message)``: an assertion that fails."""
    shown = str(message) if isinstance(message, str) else text(message)
    tell_assertion(ctx, False, "", shown)


@internal_action("jacaros.assert_fail", arity=2)
def assert_fail(ctx: Context, goal: Term, failed: Term) -> None:
    """``jacaros.assert_fail(Goal, failed|achieved)``: how a goal that ought to fail has ended."""
    passed = text(failed) == "failed"
    tell_assertion(ctx, passed, f"!{text(goal)} to fail", "" if passed else "it was achieved")


@internal_action("jacaros.fake", arity=(1, 2))
def fake(ctx: Context, action: Term, outcome: Term = None) -> None:
    """``jacaros.fake(Action [,Outcome])``: the test answers this external action in place of the environment.

    Raises:
        ActionError: nobody tests this agent, or the outcome is none.
    """
    try:
        probe_of(ctx, "fake_action").fake(action, outcome)
    except ValueError as wrong:
        raise ActionError(str(wrong)) from None


@internal_action("jacaros.assert_did", arity=(1, 2))
def assert_did(ctx: Context, action: Term, times: Term = None) -> None:
    """``jacaros.assert_did(Action [,Times])``: the agent has begun an external action that matches (so many times)."""
    acts = probe_of(ctx, "assert_did").acts()
    told = f"it did {', '.join(map(text, acts))}" if acts else "it did nothing"
    if times is None:
        tell_assertion(ctx, _is_in(action, acts), text(action), told)
    else:
        count = sum(_is_in(action, [act]) for act in acts)
        tell_assertion(ctx, float(count) == times, f"{text(times)} times {text(action)}", told)


@internal_action("jacaros.assert_printed", arity=1)
def assert_printed(ctx: Context, part: Term) -> None:
    """``jacaros.assert_printed(Text)``: a line that the agent has printed has this in it."""
    shown = display(part)
    prints = probe_of(ctx, "assert_printed").prints()
    told = (
        f"it printed {', '.join(repr(line) for line in prints[-_SHOWN:])}" if prints else "it printed nothing"
    )
    tell_assertion(ctx, any(shown in line for line in prints), f"the print {shown!r}", told)


@internal_action("jacaros.assert_not_did", arity=1)
def assert_not_did(ctx: Context, action: Term) -> None:
    """``jacaros.assert_not_did(Action)``: the agent has begun no external action that matches."""
    acts = probe_of(ctx, "assert_not_did").acts()
    tell_assertion(
        ctx, not _is_in(action, acts), f"no {text(action)}", f"it did {', '.join(map(text, acts))}"
    )
