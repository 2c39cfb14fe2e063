"""What generated code calls: the names of its global namespace.

Nothing here knows of agents beyond what is passed in: tables of beliefs, the trail, the context of internal actions.
"""

from collections.abc import Generator, Iterator
from typing import Any, NoReturn

from jacaros.errors import InternalError
from jacaros.terms import plans
from jacaros.terms.arithmetic import affirm, binary, divide, integer_divide, negate, power, remainder
from jacaros.terms.negation import positive_form, qualify
from jacaros.terms.order import annotation_set, at_most, less
from jacaros.terms.unifier import (
    ATOMIC,
    Trail,
    each_annotation_match,
    equal,
    free_variables,
    rename,
    resolve,
    undo,
    unify,
    unify_annotations,
)
from jacaros.terms.values import (
    BY_SELF,
    CONS,
    SOURCE,
    SOURCE_SELF,
    Annotated,
    Functor,
    String,
    Term,
    Var,
    annotations_of,
    atom,
    bare,
    deref,
    functor,
    list_items,
    make_list,
)


class Fail(Exception):
    """A formula does not hold: the step fails with the error that goes with its kind."""


class Failure(Fail):
    """A step fails with given annotations.

    Attributes:
        annotations: terms for the failure event, ``error(..)`` among them.
    """

    def __init__(self, *annotations: Term) -> None:
        super().__init__(*annotations)
        self.annotations = annotations


class NextPlan(Exception):
    """Among all applicable plans, one answer of a plan's context is enough."""


NESTED = 100
"""So many generators may be nested: each is a level of Python's stack, of which a thousand are allowed."""

SUSPENDED = object()
"""What a step returns when its intention has to wait."""

Answers = Generator[Any, Any, None]


def run(question: Answers, limit: int, allowed: int | None = None) -> Iterator[Any]:
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


def deeper(agent: Any, trail: Trail, question: Answers) -> Iterator[Any]:
    """The rest of a search that is nested too deeply to go on by Python's stack."""
    return run(question, trail.room, agent.rule_depth)


def too_many_open(limit: int) -> NoReturn:
    """A search has no room left.

    Raises:
        RecursionError: always.
    """
    raise RecursionError(f"more than {limit} rules and conditions are open at once (option rule_depth)")


def exists(answers: Iterator[Any], trail: Trail) -> bool:
    """Whether there is an answer; bindings are taken back."""
    mark, room = len(trail), trail.room
    for _ in answers:
        undo(trail, mark)
        trail.room = room
        return True
    return False


def solve(agent: Any, table: Any, arguments: tuple[Term, ...], trail: Trail) -> Answers:
    """Answers of a predicate in the order of its base: facts by unification, rules by their functions."""
    for entry, _ in list(table.candidates(arguments)):
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
    agent: Any, table: Any, arguments: tuple[Term, ...], items: tuple[Term, ...], tail: Term, trail: Trail
) -> Answers:
    """Answers of a predicate that is asked with annotations."""
    for entry, annotations in list(table.candidates(arguments)):
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


def facts(
    table: Any, arguments: tuple[Term, ...], trail: Trail, lasting: bool = False
) -> Iterator[tuple[Term, ...]]:
    """The answers of a predicate that are facts, by unification; *lasting* ones stay when beliefs change."""
    rows = table.rows_like(arguments)
    for row in list(rows) if lasting else rows:
        if row.__class__ is tuple:
            mark = len(trail)
            if unify_rows(arguments, row, trail):
                yield arguments
            undo(trail, mark)


def solve_held(agent: Any, table: Any, arguments: tuple[Term, ...], trail: Trail) -> Answers:
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


def unify_rows(left: tuple[Term, ...], right: tuple[Term, ...], trail: Trail) -> bool:
    """Unify arguments pairwise."""
    for a, b in zip(left, right, strict=True):  # noqa: SIM110 - a generator would cost as much as the rest
        if a is not b and not unify(a, b, trail):
            return False
    return True


def answers_of(context: Any, trail: Trail, action: Any, *arguments: Term) -> Iterator[None]:
    """The answers of a backtracking internal action, on the given trail; its bindings are undone in between.

    An error inside ends the answers and is reported: in a condition an action that cannot be done does not hold.
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


def first_answer_of(context: Any, trail: Trail, action: Any, *arguments: Term) -> bool:
    """The first answer of a backtracking internal action that is a step of its own: errors fail the step."""
    del trail
    return any(True for _ in action.function(context, *arguments))


def holds(context: Any, trail: Trail, action: Any, *arguments: Term) -> bool:
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


def wrong_arity(action: Any, count: int) -> str:
    """What is wrong with calling an internal action with so many arguments."""
    most = action.maximum
    expected = (
        str(action.minimum)
        if most == action.minimum
        else f"{action.minimum} to {most if most is not None else 'any'}"
    )
    return f"{action.name} takes {expected} arguments, not {count}"


def refuse(action: Any, count: int) -> bool:
    """A step calls an internal action with a number of arguments that it does not take."""
    error = (functor("error", 1), atom("wrong_arguments"))
    raise Failure(error, (functor("error_msg", 1), String(wrong_arity(action, count))))


def refuse_quietly(context: Any, action: Any, count: int) -> bool:
    """A condition calls an internal action with a number of arguments that it does not take: it does not hold."""
    context.report(action.name, wrong_arity(action, count))
    return False


def unknown(context: Any, name: str) -> bool:
    """A condition calls an internal action that does not exist: it does not hold."""
    context.report(name, "there is no such internal action")
    return False


_ACTS = frozenset({".send", ".broadcast", ".wait", ".stopMAS", ".suspend"})


def takes_time(action: Any) -> bool:
    """Whether an internal action cannot be a condition, because it waits, or acts on others."""
    return bool(action.suspends) and (action.name[0] != "." or action.name in _ACTS)


def cannot_wait(context: Any, action: Any) -> bool:
    """A condition calls an internal action that may suspend the intention: it does not hold."""
    context.report(action.name, "it takes time, or acts on the intention, and cannot be a condition")
    return False


def release(variables: list[Var]) -> None:
    """Take back the values of variables that were free when a loop began."""
    for variable in variables:
        variable.ref = None


def literal_of(goal: tuple[Any, ...], annotations: Any) -> Term:
    """The literal of a goal or event, with its annotations."""
    symbol = goal[0].functor
    term = (symbol, *goal[1:]) if len(goal) > 1 else symbol
    found = annotations_of_event(annotations)
    return Annotated(term, found) if found else term


def namespace_of(symbol: Functor) -> Term:
    """The name of a functor's namespace, as programs see it."""
    return atom(symbol.namespace or "default")


def annotations_of_event(annotations: Any) -> tuple[Term, ...]:
    """The annotations of an event; those of failure events are made when first asked for."""
    found: tuple[Term, ...] = annotations if annotations.__class__ is tuple else annotations.annotations()
    return found


def positive(term: Term) -> Term:
    """A negated literal without its negation; annotations are kept."""
    plain = positive_form(bare(term))
    annotations = annotations_of(term)
    return Annotated(plain, annotations) if annotations else plain


def own_annotations(items: tuple[Term, ...], tail: Term = None) -> tuple[Term, ...]:
    """The annotations of a belief or goal of one's own: ``source(self)`` is added when no source is named."""
    found = [resolve(i) for i in items]
    if tail is not None:
        found.extend(resolve(i) for i in list_items(tail))
    if not any((a.__class__ is tuple and a[0] is SOURCE) or _is_source(a) for a in found):
        found.append(SOURCE_SELF)
    return annotation_set(tuple(found))


def _is_source(term: Term) -> bool:
    inner = bare(term)
    return inner.__class__ is tuple and inner[0] is SOURCE


def resolve_all(terms: tuple[Term, ...]) -> tuple[Term, ...]:
    """Apply all bindings to each."""
    return tuple(resolve(t) for t in terms)


def namespace_name(term: Term) -> str | None:
    """The namespace that an atom names."""
    name = getattr(bare(term), "name", None)
    return None if name == "default" else name


def literal_in(name: str, negated: bool, namespace: str | None, *arguments: Term) -> Term:
    """A literal whose namespace became known at run time."""
    symbol = functor(name, len(arguments), negated, namespace)
    return (symbol, *arguments) if arguments else symbol


def deconstruct(left: Term, right: Term, trail: Trail) -> bool:
    """The relation ``=..``: a literal and the list ``[namespace, functor, arguments, annotations]``."""
    term = resolve(left)
    if term.__class__ is Var:
        return _construct(term, [resolve(i) for i in list_items(right)], trail)
    inner = bare(term)
    if inner.__class__ is tuple and inner[0] is plans.PLAN:
        return unify(make_list(_plan_parts(inner)), right, trail)
    if inner.__class__ is tuple and inner[0] is not CONS:
        symbol, arguments = inner[0], inner[1:]
    elif inner.__class__ is Functor:
        symbol, arguments = inner, ()
    else:
        return False
    name = functor(symbol.name, 0, symbol.negated)
    parts = [atom(symbol.namespace or "default"), name, make_list(arguments), make_list(annotations_of(term))]
    return unify(make_list(parts), right, trail)


def deconstruct_in(namespace: Term, left: Term, right: Term, trail: Trail) -> bool:
    """The relation ``=..`` for a left side that is written in a namespace: its name, or a variable for it."""
    term = resolve(left)
    if term.__class__ is not Var:
        name = namespace if namespace.__class__ is str else namespace_name(resolve(namespace))
        return deconstruct(qualify(term, name, False), right, trail)
    parts = [resolve(i) for i in list_items(right)]
    if len(parts) != 4:
        return False
    wanted = atom(namespace) if namespace.__class__ is str else namespace
    return unify(wanted, parts[0], trail) and _construct(term, parts, trail, namespace_name(parts[0]))


def _plan_parts(plan: Term) -> list[Term]:
    """Label, trigger, context and body of a plan."""
    label, event, context, body = plan[1:]
    event = deref(event)
    return [label, (plans.PLAN_TRIGGER, *event[1:]), context, body]


def _construct(variable: Term, parts: list[Term], trail: Trail, allowed: str | None = None) -> bool:
    if len(parts) == 3:
        parts = [atom("default"), *parts]
    if len(parts) == 4 and parts[1].__class__ is tuple and parts[1][0] in plans.TRIGGERS:
        return unify(variable, _plan_of(*parts), trail)
    if len(parts) != 4 or parts[1].__class__ is not Functor:
        return False
    namespace = namespace_name(parts[0])
    if namespace != allowed:
        return False
    arguments = tuple(list_items(parts[2]))
    symbol = functor(parts[1].name, len(arguments), parts[1].negated, namespace)
    term: Term = (symbol, *arguments) if arguments else symbol
    annotations = annotation_set(tuple(list_items(parts[3])))
    return unify(variable, Annotated(term, annotations) if annotations else term, trail)


def _plan_of(label: Term, event: Term, context: Term, body: Term) -> Term:
    if plans.is_body(body):
        body = plans.make_body(plans.body_steps(body))
    return (plans.PLAN, label, (plans.TRIGGER, *event[1:]), context, body)


CLOSED = frozenset({float, String, Functor})
"""Values that never unify with a structure."""


class Remaining:
    """The answers of a ``for`` that are still to come: searched for one by one, and plain data when asked for.

    Whoever copies or stores an intention takes `items`; the search is over then.
    """

    __slots__ = ("_search",)

    def __init__(self, search: Iterator[tuple[Term, ...]]) -> None:
        self._search = search

    def __iter__(self) -> Iterator[tuple[Term, ...]]:
        return self._search

    def items(self) -> list[tuple[Term, ...]]:
        """All answers to come, with the values of the variables that the loop binds."""
        found = [tuple(resolve(value) for value in answer) for answer in self._search]
        self._search = iter(found)
        return found

    def copy(self) -> "Remaining":
        """The same answers, for a copy of the intention."""
        return Remaining(iter(self.items()))


def still_held(table: Any, rows: list[tuple[Term, ...]]) -> Iterator[tuple[Term, ...]]:
    """The rows of a loop over beliefs: one is fixed ahead, those that are deleted before their turn are left out."""
    source = iter(rows)
    ahead = next(source, None)
    while ahead is not None:
        current = ahead
        ahead = next((row for row in source if row in table.rows), None)
        yield current


def join_branch(agent: Any, frame: list[Any]) -> Any:
    """The step behind the last one of a branch of ``|&|`` or ``|||``."""
    return agent.join_branch(frame)


_FUNCTIONS = (
    affirm,
    annotation_set,
    annotations_of_event,
    answers_of,
    at_most,
    binary,
    cannot_wait,
    deconstruct,
    deconstruct_in,
    deeper,
    deref,
    divide,
    equal,
    exists,
    facts,
    first_answer_of,
    free_variables,
    holds,
    integer_divide,
    join_branch,
    less,
    literal_in,
    literal_of,
    make_list,
    namespace_name,
    namespace_of,
    negate,
    own_annotations,
    positive,
    power,
    qualify,
    refuse,
    refuse_quietly,
    release,
    remainder,
    resolve,
    resolve_all,
    run,
    solve,
    solve_annotated,
    solve_held,
    still_held,
    too_many_open,
    undo,
    unify,
    unify_annotations,
    unify_rows,
    unknown,
)
_CLASSES = (Annotated, Fail, InternalError, NextPlan, Remaining, Functor, String, Trail, Var)

NAMES: dict[str, Any] = {
    **{item.__name__: item for item in (*_FUNCTIONS, *_CLASSES)},
    "ATOMIC": ATOMIC,
    "BY_SELF": BY_SELF,
    "CLOSED": CLOSED,
    "CONS": CONS,
    "NESTED": NESTED,
    "copy": rename,
    "new": object.__new__,
}
"""The global names of generated code."""
