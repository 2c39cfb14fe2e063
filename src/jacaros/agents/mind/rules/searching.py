"""Searches that generated code makes among facts and rules."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from operator import length_hint
from typing import Any, NoReturn, Protocol

from jacaros.agents.mind.actions.internal_action import InternalAction
from jacaros.agents.mind.state.belief_base import Table
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.plan import Answers, Failure
from jacaros.agents.terms.substitution import resolve
from jacaros.agents.terms.unifier import Trail, each_annotation_match, undo, unify
from jacaros.agents.terms.values import String, Term, Var, atom, functor
from jacaros.runtime.errors import InternalError

# Calls of internal actions from generated code, and the failure of calls that are invalid.


class Calling(Protocol):
    """The view that internal actions have of their agent (`context.Context`), as calls need it: views import this."""

    agent: Circumstance
    trail: Trail

    def report(self, action: str, fault: object) -> None:
        """Warn that an action in a condition failed."""


def answers_of(context: Calling, trail: Trail, action: InternalAction, *arguments: Term) -> Iterator[None]:
    """Yield the answers of a backtracking internal action, on the given trail; its bindings are undone in between.

    An error inside ends the answers and is reported: in a condition, a failing action does not hold.
    """
    mark = len(trail)
    generator = action.function(context, *arguments)
    beliefs = context.agent.beliefs
    while True:
        outer, context.trail = context.trail, trail
        within, beliefs.searching = beliefs.searching, beliefs.next_call()
        try:
            found = next(generator, generator)
        except InternalError:
            raise
        except Exception as fault:
            context.report(action.name, fault)
            return
        finally:
            context.trail = outer
            beliefs.searching = within
        if found is generator:
            return
        if beliefs.budget is not None:
            beliefs.budget.spend()
        yield
        undo(trail, mark)


def values_of(context: Calling, action: InternalAction, *arguments: Term) -> Iterable[Term]:
    """Yield the values of the first argument in all answers of a backtracking internal action, as `answers_of`.

    *arguments* are the others; the first one is unbound.
    """
    assert action.values is not None
    try:
        return action.values(*arguments)
    except InternalError:
        raise
    except Exception as fault:
        context.report(action.name, fault)
        return ()


def first_answer_of(context: Calling, trail: Trail, action: InternalAction, *arguments: Term) -> bool:
    """The first answer of a backtracking internal action that is a step of its own: errors fail the step."""
    del trail
    for _ in action.function(context, *arguments):
        return True
    return False


def holds(context: Calling, trail: Trail, action: InternalAction, *arguments: Term) -> bool:
    """Whether an internal action succeeds as a condition, on the given trail; an error is reported and counts as no."""
    outer, context.trail = context.trail, trail
    beliefs = context.agent.beliefs
    within, beliefs.searching = beliefs.searching, beliefs.next_call()
    try:
        return action.function(context, *arguments) is not False
    except InternalError:
        raise
    except Exception as fault:
        context.report(action.name, fault)
        return False
    finally:
        context.trail = outer
        beliefs.searching = within


def wrong_arity(action: InternalAction, count: int) -> str:
    """Describe a call of an internal action with a wrong number of arguments."""
    most = action.maximum
    expected = (
        str(action.minimum)
        if most == action.minimum
        else f"{action.minimum} to {most if most is not None else 'any'}"
    )
    given = f"{action.name} expects {expected} argument{'' if expected == '1' else 's'}, found {count}"
    return (
        f"{given}; {action.result_hint}"
        if most is not None and count == most + 1 and action.result_hint
        else given
    )


def refuse(action: InternalAction, count: int) -> bool:
    """Fail a step that calls an internal action with a wrong number of arguments."""
    error = (functor("error", 1), atom("wrong_arguments"))
    raise Failure(error, (functor("error_msg", 1), String(wrong_arity(action, count))))


def refuse_quietly(context: Calling, action: InternalAction, count: int) -> bool:
    """Report a condition that calls an internal action with a wrong number of arguments: it does not hold."""
    context.report(action.name, wrong_arity(action, count))
    return False


def unknown(context: Calling, name: str) -> bool:
    """Report a condition that calls an unknown internal action: it does not hold."""
    context.report(name, "unknown internal action")
    return False


def cannot_wait(context: Calling, action: InternalAction) -> bool:
    """Report a condition that calls an internal action that may suspend the intention: it does not hold."""
    context.report(action.name, "it takes time or acts on the intention, and cannot be a condition")
    return False


def run(question: Answers, limit: int, allowed: int | None = None) -> Iterator[tuple[Term, ...]]:
    """Drive a search generator: a tuple it yields is an answer, a generator is to be run for it.

    The stack of generators is a list, so depth costs no Python recursion.

    Args:
        question: the generator.
        limit: how many rules and conditions may be open at the same time.
        allowed: the limit to name when it is passed, where *limit* is what is left of it.

    Raises:
        RecursionError: more of them are open.
    """
    stack: list[Answers] = []
    opened = [question]
    current, answer = question, None
    try:
        while True:
            try:
                item = current.send(answer)
            except StopIteration:
                # Whatever was opened after it was opened on its behalf.
                while (last := opened.pop()) is not current:
                    last.close()
                if not stack:
                    return
                current, answer = stack.pop(), None
                continue
            if item.__class__ is tuple:
                if stack:
                    current, answer = stack.pop(), item
                else:
                    yield item
                    answer = None
            else:
                stack.append(current)
                if not item.gi_suspended:
                    opened.append(item)
                    if len(opened) > limit:
                        too_many_open(limit if allowed is None else allowed)
                current, answer = item, None
    finally:
        # A generator holds the one it asks: freed from the first on, a long chain would overflow the C stack.
        while opened:
            opened.pop().close()


def deeper(agent: Circumstance, trail: Trail, question: Answers) -> Iterator[tuple[Term, ...]]:
    """The rest of a search that is nested too deeply to go on by Python's stack."""
    return run(question, trail.room, agent.options.rule_depth)


def too_many_open(limit: int) -> NoReturn:
    """A search has no room left.

    Raises:
        RecursionError: always.
    """
    raise RecursionError(f"more than {limit} rules and conditions are open at once (option rule_depth)")


def exists(answers: Iterator[object], trail: Trail) -> bool:
    """Whether there is an answer; bindings are taken back."""
    mark, room = len(trail), trail.room
    for _ in answers:
        undo(trail, mark)
        trail.room = room
        return True
    return False


def solve(
    agent: Circumstance, table: Any, arguments: tuple[Term, ...], trail: Trail, lasting: bool = True
) -> Answers:
    """Answers of a predicate in the order of its base: facts by unification, rules by their functions.

    *lasting* ones may be taken while beliefs change.
    """
    candidates = table.candidates(arguments)
    for entry, _ in still_held(table, list(candidates)) if lasting else candidates:
        mark = len(trail)
        if entry.__class__ is tuple:
            if unify_rows(arguments, entry, trail):
                yield arguments
        else:
            search = entry.search(agent, arguments, trail)
            while (yield search) is not None:
                yield arguments
        undo(trail, mark)


def solve_annotated(
    agent: Circumstance,
    table: Any,
    arguments: tuple[Term, ...],
    items: tuple[Term, ...],
    tail: Term,
    trail: Trail,
) -> Answers:
    """Answers of a predicate that is asked with annotations."""
    for entry, annotations in still_held(table, list(table.candidates(arguments))):
        mark = len(trail)
        if entry.__class__ is tuple:
            if unify_rows(arguments, entry, trail):
                for _ in each_annotation_match(items, tail, annotations, None, trail):
                    yield arguments
        else:
            search = entry.search(agent, arguments, trail)
            while (answer := (yield search)) is not None:
                held = answer[0] if answer else annotations
                for _ in each_annotation_match(items, tail, held, None, trail):
                    yield arguments
        undo(trail, mark)


def solve_held(agent: Circumstance, table: Any, arguments: tuple[Term, ...], trail: Trail) -> Answers:
    """Answers of a predicate as `solve` has them, each as a pair with the annotations that go with it."""
    for entry, annotations in table.candidates(arguments):
        mark = len(trail)
        if entry.__class__ is tuple:
            if unify_rows(arguments, entry, trail):
                yield arguments, annotations
        else:
            search = entry.search(agent, arguments, trail)
            while (answer := (yield search)) is not None:
                yield arguments, (answer[0] if answer else annotations)
        undo(trail, mark)


def facts(
    table: Table, arguments: tuple[Term, ...], trail: Trail, lasting: bool = False
) -> Iterator[tuple[Term, ...]]:
    """The answers of a predicate that are facts, by unification; *lasting* ones may be taken while beliefs change."""
    rows = table.rows_like(arguments)
    for row in rows_still_held(table, list(rows)) if lasting else rows:
        if row.__class__ is tuple:
            mark = len(trail)
            if unify_rows(arguments, row, trail):
                yield arguments
            undo(trail, mark)


def unify_rows(left: tuple[Term, ...], right: tuple[Term, ...], trail: Trail) -> bool:
    """Unify arguments pairwise."""
    for a, b in zip(left, right, strict=True):  # noqa: SIM110 - a generator would cost as much as the rest
        if a is not b and not unify(a, b, trail):
            return False
    return True


def release(variables: Iterable[Var]) -> None:
    """Take back the values of variables that were free when a loop began."""
    for variable in variables:
        variable.ref = None


def rows_still_held(table: Table, rows: list[tuple[Term, ...]]) -> Iterator[tuple[Term, ...]]:
    """The rows of a search that goes on while beliefs change: one is fixed ahead, those that are deleted before their turn
    are left out."""
    current = None
    for ahead in rows:
        if current is not None:
            if ahead not in table.rows:
                continue
            yield current
        current = ahead
    if current is not None:
        yield current


def still_held(table: Any, items: list[Any]) -> Iterator[Any]:
    """The same for entries of all kinds with their annotations."""
    current = None
    for ahead in items:
        if current is not None:
            if not table.still_holds(ahead[0]):
                continue
            yield current
        current = ahead
    if current is not None:
        yield current


class Remaining:
    """The answers of a ``for`` that are still to come: searched for one by one until the intention is copied."""

    __slots__ = ("_answers", "_found")

    def __init__(self, answers: Iterable[tuple[Term, ...]]) -> None:
        self._answers = iter(answers)
        self._found = answers if isinstance(answers, list) else None

    def __reduce__(self) -> tuple[Any, ...]:
        return Remaining, (list(self.copy()),)

    def __iter__(self) -> Iterator[tuple[Term, ...]]:
        return self._answers

    def copy(self) -> "Remaining":
        """The same answers, for a copy of the intention.

        The first copy ends the search.  From then on all copies share one list, each with its own place in it.
        """
        found = self._found
        if found is None:
            found = self._found = [tuple(map(resolve, answer)) for answer in self._answers]
            self._answers = iter(found)
        other = Remaining(found)
        other._answers.__setstate__(len(found) - length_hint(self._answers))  # type: ignore[attr-defined]
        return other


@dataclass(slots=True, eq=False)
class Loop:
    """What a loop gives back at the beginning of each round, kept in a frame behind the variables.

    Attributes:
        free: variables that had no value when the loop began.
        inner: places in the frame of variables that get their first value inside the loop.
        round: variables without value that the present round of a ``for`` has brought.
        answers: those of a ``for`` that are still to come.
    """

    free: Sequence[Var]
    inner: Sequence[int]
    answers: Remaining | None = None
    round: Sequence[Var] = ()

    def begin_round(self, frame: list[Any]) -> None:
        """Take back what the last round bound."""
        release(self.free)
        release(self.round)
        for place in self.inner:
            frame[place] = None

    def copy(self, names: dict[Var, Var]) -> "Loop":
        """The same for a copy of the intention, whose variables have other names."""
        other = Loop(self.free, self.inner, self.answers and self.answers.copy())
        if self.free or self.round:
            other.free = [names.get(each, each) for each in self.free]
            other.round = [names.get(each, each) for each in self.round]
        return other
