"""Units of generated code, made into functions; those of a program are kept from run to run.

A unit is kept under everything that decides its code: the syntax of its plans and rules with their lines and files, and the
declarations of the internal actions that they call.  (The versions of Python and of this package are for the `CodeCache`.)
The entry is the compiled code, and how to make its constants: terms as they are, plans, steps and actions by their places.
"""

import marshal
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import fields
from hashlib import sha256
from types import CodeType
from typing import Any, cast

from jacaros.asl import nodes
from jacaros.bdi.actions.internal_action import STANDARD, InternalAction
from jacaros.bdi.fast.generated import runtime
from jacaros.bdi.fast.generated.building import written
from jacaros.bdi.fast.generated.unit import Body, Written, write_rule, write_search, write_select
from jacaros.bdi.state.engine import CodeCache
from jacaros.bdi.state.plan import Plan, StepInfo
from jacaros.bdi.state.rule import Rule
from jacaros.bdi.state.triggers import Trigger, trigger
from jacaros.terms.substitution import resolve
from jacaros.terms.values import Annotated, Functor, List, String, Term, functor, make_list

Function = Callable[..., Any]
Recipe = tuple[str, Any]
"""How a constant is made: the way, and what it needs."""


class NotStorable(Exception):
    """A unit depends on something that its program does not say."""


class Units:
    """Makes functions of plans and rules.

    Args:
        actions: the internal actions that they may call.
        cache: where the code of programs is kept; None for nowhere.
    """

    def __init__(self, actions: Mapping[str, InternalAction], cache: CodeCache | None = None) -> None:
        self.actions = actions
        self._cache = cache

    def select(
        self, kind: Trigger, plans: Sequence[Plan], outer: Plan | None = None, every: bool = False
    ) -> Function:
        """The select function of an event kind, see `jacaros.bdi.fast.generated.unit.write_select`."""
        scopes = _scopes(outer)
        return self._function(
            f"select {kind.functor.arity} {every} {len(plans)} {sorted(plans[0].by_name)}",
            [plan.node for plan in (*plans, *scopes)],
            all(plan.of_program for plan in scopes[-1:] or plans),
            lambda: write_select(kind, plans, self.actions, outer, every),
            plans,
        )

    def search(
        self, symbol: Functor, pattern: int, before: Sequence[Rule], after: Sequence[Rule], trampoline: bool
    ) -> Function:
        """The generator function of a predicate for one pattern of use, see `jacaros.bdi.fast.generated.predicates`."""
        first, last = [rule.node for rule in before], [rule.node for rule in after]
        return self._function(
            f"search {_parts(symbol)} {pattern} {len(first)} {trampoline}",
            [*first, *last],
            all(rule.of_program for rule in (*before, *after)),
            lambda: write_search(symbol, pattern, first, last, self.actions, trampoline),
        )

    def rule(self, rule: Rule) -> Function:
        """The generator function of a rule."""
        return self._function(
            "rule", [rule.node], rule.of_program, lambda: write_rule(rule.node, self.actions)
        )

    def _function(
        self,
        purpose: str,
        roots: Sequence[nodes.Node],
        of_program: bool,
        write: Callable[[], Written],
        plans: Sequence[Plan] = (),
    ) -> Function:
        """The function of a unit, from the cache if it is there."""
        if self._cache is None or not of_program:
            return executed(write())
        try:
            syntax = _Syntax(roots, self.actions, plans)
        except NotStorable:
            return executed(write())
        key = sha256(f"{purpose}\n{syntax.text}".encode()).digest()
        entry = self._cache.get(key)
        if entry is not None:
            return syntax.restored(entry)
        made = write()
        code = made.unit.code()
        with suppress(NotStorable, LookupError, RecursionError, ValueError):
            self._cache.put(key, syntax.entry(made, code))
        return _installed(made.name, made.unit.globals, code, made.bodies, made.conditions)


def executed(made: Written) -> Function:
    """The function of a unit, which is executed; its plans have their steps afterwards."""
    return _installed(made.name, made.unit.globals, made.unit.code(), made.bodies, made.conditions)


def _installed(
    name: str,
    names: dict[str, Any],
    code: Iterable[CodeType],
    bodies: Iterable[Body],
    conditions: Iterable[tuple[Plan, str]],
) -> Function:
    for part in code:
        exec(part, names)  # only ever made from a syntax tree
    for plan, achieved in conditions:
        plan.goal_condition = names[achieved]
    for body in bodies:
        body.install(names)
    return cast("Function", names.get(name))  # None for a body without steps


def _scopes(plan: Plan | None) -> list[Plan]:
    """A plan and those around it, the outermost last."""
    found = []
    while plan is not None:
        found.append(plan)
        plan = plan.scope
    return found


class _Syntax:
    """The syntax that a unit is made of: written out, and as places for what its entry refers to.

    Args:
        roots: the plans or rules, and those that the plans are sub-plans of.
        actions: the internal actions.
        plans: the plans themselves.

    Attributes:
        text: everything that decides the code.

    Raises:
        NotStorable: something else decides, too.
    """

    def __init__(
        self, roots: Sequence[nodes.Node], actions: Mapping[str, InternalAction], plans: Sequence[Plan]
    ) -> None:
        self._actions, self._plans = actions, plans
        self._nodes: list[nodes.Node] = []
        self._functions: dict[int, str] = {}
        self.text = repr(self._written_out(roots)) + repr(self._declared())

    def _written_out(self, roots: Sequence[nodes.Node]) -> list[object]:
        """Every node with its line, and every part of one that is not a node, in the order of the text.

        The class of a node says how many parts follow, so two trees that are written out alike are alike.
        """
        out: list[object] = []
        file = None
        stack: list[Any] = [tuple(roots)]
        while stack:
            part = stack.pop()
            kind = part.__class__
            if kind in _LEAVES:
                out.append(part)
            elif kind is tuple:
                out.append(len(part))
                stack += part[::-1]
            elif kind is nodes.Constant or not isinstance(part, nodes.Node):
                raise NotStorable
            else:
                span, line = part.span, 0
                if span is not None:
                    line = span.line
                    if span.file is not file:
                        file = span.file
                        out.append([file.name])
                out.append((kind.__name__, line))
                self._nodes.append(part)
                stack += part.parts()[::-1]
        return out

    def _declared(self) -> list[object]:
        """What is declared of the internal actions that are called."""
        names = sorted({node.name for node in self._nodes if isinstance(node, nodes.InternalAction)})
        return [(name, *self._declaration(name)) for name in names]

    def _declaration(self, name: str) -> tuple[object, ...]:
        action = self._actions.get(name)
        if action is None:
            return ()
        same = self._functions.setdefault(id(action.function), name)
        if STANDARD.get(name) is action:
            return ("standard", same)
        if action.direct is not None:
            raise NotStorable
        return (same, action.values is None, *(getattr(action, each) for each in _DECLARED))

    # --- entries ------------------------------------------------------------------------------------------

    def entry(self, made: Written, code: list[CodeType]) -> bytes:
        """What is kept of a unit.

        Raises:
            NotStorable, LookupError, RecursionError, ValueError: it holds something that cannot be kept.
        """
        places = {id(node): place for place, node in enumerate(self._nodes)}
        number_of = self._plans.index
        calls = made.unit.calls
        constants = [
            (name, ("call", places[id(calls[name])]) if name in calls else self._recipe(value))
            for name, value in made.unit.constants()
        ]
        bodies = [
            (
                number_of(body.plan),
                body.first,
                body.size,
                [(name, places[id(info.node)], info.next) for name, info in body.steps.items()],
            )
            for body in made.bodies
        ]
        conditions = [(number_of(plan), name) for plan, name in made.conditions]
        return marshal.dumps((made.name, code, constants, bodies, conditions))

    def restored(self, entry: bytes) -> Function:
        """The function of a unit that was kept; its plans have their steps afterwards."""
        name, code, constants, bodies, conditions = marshal.loads(entry)
        names = dict(runtime.NAMES)
        for constant, recipe in constants:
            names[constant] = self._value(recipe)
        return _installed(
            name,
            names,
            code,
            [
                Body(
                    self._plans[number],
                    first,
                    size,
                    {step: StepInfo(self._nodes[place], after) for step, place, after in steps},
                )
                for number, first, size, steps in bodies
            ],
            [(self._plans[number], achieved) for number, achieved in conditions],
        )

    def _recipe(self, value: Term) -> Recipe:
        """How a constant is made."""
        kind = value.__class__
        if kind is Trigger:
            return "trigger", (value.operator, value.kind, _parts(value.functor))
        if kind is Plan:
            return "plan", self._plans.index(value)
        if kind is InternalAction:
            return "action", value.name
        if id(value) in self._functions:
            return "function", self._functions[id(value)]
        return _recipe_of_term(value)

    def _value(self, recipe: Recipe) -> Term:
        """The constant of a recipe."""
        kind, held = recipe
        if kind == "trigger":
            return trigger(held[0], held[1], functor(*held[2]))
        if kind == "plan":
            return self._plans[held]
        if kind == "action":
            return self._actions[held]
        if kind == "function":
            return self._actions[held].function
        if kind == "call":
            call = self._nodes[held]
            assert isinstance(call, nodes.InternalAction)
            direct = self._actions[call.name].direct
            assert direct is not None
            return direct(tuple(map(written, call.arguments)))
        return _term(recipe)


def _recipe_of_term(value: Term) -> Recipe:
    kind = value.__class__
    if kind is Functor:
        return "functor", _parts(value)
    if kind is float or kind is int:  # a place of an argument
        return "itself", value
    if kind is String:
        return "string", str(value)
    if kind is tuple:
        return "tuple", tuple(map(_recipe_of_term, value))
    if kind is List:
        return "list", tuple(map(_recipe_of_term, value.elements()))
    if kind is Annotated and value.tail is None:
        return "annotated", (_recipe_of_term(value.term), _recipe_of_term(value.annotations))
    raise NotStorable


def _term(recipe: Recipe) -> Term:
    kind, held = recipe
    if kind == "functor":
        return functor(*held)
    if kind == "string":
        return String(held)
    if kind == "tuple":
        return tuple(map(_term, held))
    if kind == "list":
        return resolve(make_list(map(_term, held)))
    if kind == "annotated":
        return Annotated(_term(held[0]), _term(held[1]))
    return held


def _parts(symbol: Functor) -> tuple[str, int, bool, str | None, int]:
    return symbol.name, symbol.arity, symbol.negated, symbol.namespace, symbol.kind


_LEAVES = frozenset({str, float, bool, type(None)})
"""What parts of nodes are besides nodes and tuples of them."""
_DECLARED = tuple(
    each.name for each in fields(InternalAction) if each.name not in ("function", "direct", "values")
)
"""What is compared of an internal action; the rest is Python code, which is called and not looked at."""
