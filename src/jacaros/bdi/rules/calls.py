"""Calls of internal actions from generated code, and the failure of calls that are invalid."""

from collections.abc import Iterable, Iterator
from typing import Protocol

from jacaros.bdi.actions.internal_action import InternalAction
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.plan import Failure
from jacaros.errors import InternalError
from jacaros.terms.unifier import Trail, undo
from jacaros.terms.values import String, Term, atom, functor


class Calling(Protocol):
    """The view that internal actions have of their agent (`jacaros.bdi.rules.context.Context`), as calls need it."""

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
        values = action.values(*arguments)
    except InternalError:
        raise
    except Exception as fault:
        context.report(action.name, fault)
        return ()
    budget = context.agent.beliefs.budget
    return values if budget is None else budget.counting_answers(values)


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
