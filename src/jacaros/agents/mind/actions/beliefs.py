"""Internal actions on what an agent knows: beliefs, their namespaces, rules and conditions, plans, and program files."""

from collections.abc import Callable, Iterable, Iterator
from typing import Any

from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import AslError
from jacaros.agents.language.lowering import NotAPlan, format_plan, format_term, fresh_names, lower
from jacaros.agents.mind.actions.internal_action import (
    ActionError,
    WrongArguments,
    characters,
    elements,
    internal_action,
    string,
)
from jacaros.agents.mind.actions.terms import matches_whole
from jacaros.agents.mind.rules import belief_update, body_steps
from jacaros.agents.mind.rules.context import Context
from jacaros.agents.mind.state.belief_base import Table, literal, parts, without_sources
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.plan import OpenFact, Plan, Rule
from jacaros.agents.mind.state.triggers import own_annotations
from jacaros.agents.mind.storage import knowledge
from jacaros.agents.terms.order import SortKey, annotation_set, ordered_by_python
from jacaros.agents.terms.plans import RULE
from jacaros.agents.terms.substitution import rename, resolve
from jacaros.agents.terms.text import plan_text, text
from jacaros.agents.terms.unifier import undo, unify, unify_annotations
from jacaros.agents.terms.values import (
    FALSE,
    SELF,
    SOURCE_SELF,
    TRUE,
    Annotated,
    Functor,
    String,
    Term,
    Var,
    atom,
    bare,
    functor_of,
    is_list,
    list_items,
    make_list,
)
from jacaros.runtime.errors import JacarosError


@internal_action(".abolish", arity=1)
def abolish(ctx: Context, pattern: Term) -> None:
    """``.abolish(P)`` deletes all beliefs that match, with all their sources."""
    belief_update.abolish(ctx.agent, pattern)


def _assert(ctx: Context, term: Term, last: bool) -> None:
    if term.__class__ is tuple and term[0] is RULE:
        ctx.agent.change_rule("+>" if last else "+", term)
        return
    symbol, row, annotations = parts(term)
    if symbol is None:
        raise WrongArguments(f"expected a literal or a rule, found {text(term)}")
    own = own_annotations(annotations)
    table = ctx.agent.beliefs[symbol]
    new = belief_update.insert(table, row, own, last)
    if new is not None:
        belief_update.raise_event(ctx.agent, table.added, row, new)


@internal_action(".asserta", arity=1)
def asserta(ctx: Context, term: Term) -> None:
    """``.asserta(L)`` adds a belief or rule at the beginning."""
    _assert(ctx, term, last=False)


@internal_action(".assertz", arity=1)
def assertz(ctx: Context, term: Term) -> None:
    """``.assertz(L)`` adds a belief or rule at the end."""
    _assert(ctx, term, last=True)


@internal_action(".belief", arity=1, backtracks=True, pure=True)
def belief(ctx: Context, pattern: Term) -> Iterator[None]:
    """``.belief(P)``: *P* is a matching belief; rules are not considered."""
    wanted = functor_of(pattern)
    for each in list(ctx.agent.beliefs.literals()):
        if (wanted is None or functor_of(each) is wanted) and ctx.unify(pattern, each):
            yield


@internal_action(".list_rules", arity=0)
def list_rules(ctx: Context) -> None:
    """``.list_rules`` prints the rules."""
    for table in ctx.agent.beliefs.values():
        for entry, _ in _rules(table):
            lookup = fresh_names()
            head = Annotated(bare(lower(entry.node.head, lookup)), entry.head_annotations())
            ctx.architecture.print(f"{text(head)} :- {text(lower(entry.node.body, lookup))}")


def _rules(table: Table) -> Iterator[tuple[Any, tuple[Term, ...]]]:
    """Yield the rules of a table with their annotations; a fact of the program with variables is one without conditions."""
    for entry, held in table.entries():
        if isinstance(entry, Rule | OpenFact) and entry.node is not None:
            yield entry, held


@internal_action(".relevant_rules", arity=2)
def relevant_rules(ctx: Context, pattern: Term, target: Term) -> bool:
    """``.relevant_rules(P, Rs)``: Rs is the list of the rules that can prove a literal, in the order of the belief base.

    With *P* unbound, it is the list of all rules.
    """
    symbol, _, annotations = parts(pattern)
    beliefs = ctx.agent.beliefs
    if symbol is not None:
        tables: Iterable[Table] = (beliefs[symbol],)
    elif bare(pattern).__class__ is Var:
        tables = beliefs.values()
    elif is_list(pattern):
        tables = ()  # a literal in Jason, but no rule has such a head
    else:
        raise WrongArguments(f"expected a literal, found {text(pattern)}")
    found = []
    for table in tables:
        for entry, held in _rules(table):
            rule = lower(nodes.RuleTerm(entry.node), fresh_names())
            mark = len(ctx.trail)
            fits = unify(bare(pattern), bare(rule[1]), ctx.trail) and unify_annotations(
                annotations, None, held, None, ctx.trail
            )
            undo(ctx.trail, mark)
            if fits:
                head = rule[1] if isinstance(entry, Rule) else Annotated(rule[1], held)
                found.append((rule[0], without_sources(head), rule[2]))
    return ctx.unify(target, make_list(found))


@internal_action(".eval", arity=2, pure=True)
def evaluate(ctx: Context, target: Term, formula: Term) -> bool:
    """``.eval(X, F)``: X is ``true`` if the formula F holds, otherwise ``false``."""
    mark = len(ctx.trail)
    holds = ctx.succeeds(formula)
    undo(ctx.trail, mark)
    return ctx.unify(target, TRUE if holds else FALSE)


@internal_action(".findall", arity=3, condition=1, collects=True, pure=True)
def findall(found: list[Term]) -> Term:
    """``.findall(T, F, L)``: L is the list of T for all answers of F, in order, with duplicates."""
    return make_list(found)


@internal_action(".setof", arity=3, condition=1, collects=True, pure=True)
def setof(found: list[Term]) -> Term:
    """``.setof(T, F, L)``: like `.findall`, sorted and without duplicates."""
    return make_list(annotation_set(tuple(found)))


@internal_action(".count", arity=2, condition=0, collects=True, pure=True)
def count(found: list[Term]) -> Term:
    """``.count(F, N)``: N is the number of answers of F."""
    return float(len(found))


@internal_action(".max", arity=(2, 3), pure=True)
def greatest(ctx: Context, *arguments: Term) -> bool:
    """``.max(L, X)``: *X* is the greatest element of a list in the standard order. Fails for an empty list.

    ``.max(T, F, X)``: *X* is the greatest instance of *T* among the answers of the formula *F*. Fails without answers.
    """
    return _extreme(ctx, arguments, max, ".max")


@internal_action(".min", arity=(2, 3), pure=True)
def least(ctx: Context, *arguments: Term) -> bool:
    """``.min(L, X)``: *X* is the smallest element of a list in the standard order. Fails for an empty list.

    ``.min(T, F, X)``: *X* is the smallest instance of *T* among the answers of the formula *F*. Fails without answers.
    """
    return _extreme(ctx, arguments, min, ".min")


def _extreme(ctx: Context, arguments: tuple[Term, ...], pick: Callable[..., Term], name: str) -> bool:
    """Find the greatest or smallest element; the first of equal ones counts."""
    *first, target = arguments
    items = (
        _instances(ctx, *first) if len(first) == 2 else elements(first[0], f"the first argument of {name}")
    )
    if not items:
        return False
    return ctx.unify(target, pick(items) if ordered_by_python(items) else pick(items, key=SortKey))


def _instances(ctx: Context, template: Term, formula: Term) -> list[Term]:
    mark = len(ctx.trail)
    found = [rename(resolve(template)) for _ in ctx.answers(formula)]
    undo(ctx.trail, mark)
    return found


@internal_action(".perceive", arity=0)
def perceive(ctx: Context) -> None:
    """``.perceive`` perceives the environment; it has no effect here, as percepts are taken in before every cycle."""
    del ctx


@internal_action(".namespace", arity=1, backtracks=True, pure=True)
def namespace(ctx: Context, target: Term) -> Iterator[None]:
    """``.namespace(N)``: *N* is a namespace in use; one answer for each."""
    names: dict[str, None] = {"default": None}
    for symbol, table in ctx.agent.beliefs.items():
        if symbol.namespace and len(table):
            names[symbol.namespace] = None
    for plan in ctx.agent.library.plans:
        symbol = plan.trigger_functor()
        if symbol is not None and symbol.namespace:
            names[symbol.namespace] = None

    for name in names:
        if ctx.unify(target, atom(name)):
            yield


def _properties(ctx: Context, namespace: Term) -> dict[Term, Term]:
    """Return the properties of a namespace by key; changes to the dictionary are kept."""
    if not isinstance(namespace, Functor):
        raise WrongArguments(f"the first argument must be the name of a namespace, not {text(namespace)}")
    found: dict[Term, Term] = ctx.agent.beliefs.namespace_properties.setdefault(namespace.name, {})
    return found


@internal_action(".namespace_set_prop", arity=3)
def set_property(ctx: Context, namespace: Term, key: Term, value: Term) -> None:
    """``.namespace_set_prop(N, Key, Value)`` sets a property of a namespace."""
    if not isinstance(key, Functor):
        raise WrongArguments(f"the key of a property must be an atom, not {text(key)}")
    _properties(ctx, namespace)[key] = value


@internal_action(".namespace_get_prop", arity=(2, 4), backtracks=True)
def get_property(ctx: Context, namespace: Term, key: Term, *rest: Term) -> Iterator[None]:
    """``.namespace_get_prop(N, Key[, Value[, Default]])``: *Value* is a property of a namespace, or the default.

    With *Key* unbound, there is an answer for each property.
    """
    held = _properties(ctx, namespace)
    if key.__class__ is Var:
        for each, value in list(held.items()):
            if ctx.unify_all((key, each), *(((rest[0], value),) if rest else ())):
                yield
        return
    value = held.get(key, rest[1] if len(rest) > 1 else None)
    if value is not None and (not rest or ctx.unify(rest[0], value)):
        yield


# Internal actions on the plan library and program files.


def _source(term: Term) -> Term:
    """Return the source that an argument names, the agent itself by default."""
    return SELF if term is None else bare(term)


@internal_action(".add_plan", arity=(1, 3), brings_in=True, changes_plans=True)
def add_plan(ctx: Context, plan: Term, source: Term = None, where: Term = None) -> None:
    """``.add_plan(P [,Source [,begin]])`` adds a plan. *P* is a plan term, a string, or a list of them."""
    first = where is not None and bare(where) is atom("begin")
    try:
        ctx.agent.add_plan(plan, _source(source), first)
    except NotAPlan as fault:
        raise WrongArguments(str(fault)) from fault
    except AslError as fault:
        raise ActionError(f"not a plan: {fault}") from fault


@internal_action(".remove_plan", arity=(1, 2), changes_plans=True)
def remove_plan(ctx: Context, wanted: Term, source: Term = None) -> None:
    """``.remove_plan(Label [,Source])`` removes a plan by its label. *Label* may be a list of labels or a plan term; the
    plan need not exist.
    """
    for item in list_items(wanted) if is_list(wanted) else (wanted,):
        ctx.agent.remove_plan(item, _source(source))


@internal_action(".plan_label", arity=2, backtracks=True, pure=True)
def plan_label(ctx: Context, target: Term, label: Term) -> Iterator[None]:
    """``.plan_label(P, L)``: *P* is a plan and *L* its label; one answer for each plan."""
    for plan in list(ctx.agent.library.plans):
        if ctx.unify_all(
            (label, ctx.agent.library.label(plan)), (target, body_steps.plan_term(ctx.agent, plan))
        ):
            yield


def _relevant(ctx: Context, event: Term) -> list[Plan]:
    plans = body_steps.relevant_plans(ctx.agent, event)
    if plans is None:
        raise WrongArguments(f"expected an event such as {{+!g}}, found {text(event)}")
    return plans


@internal_action(".relevant_plans", arity=(2, 3), pure=True)
def relevant_plans(ctx: Context, event: Term, target: Term, labels: Term = None) -> bool:
    """``.relevant_plans({T}, Ps [,Labels])``: *Ps* is the list of the plans whose triggers unify with an event, in
    order.
    """
    plans = _relevant(ctx, event)
    if not ctx.unify(target, make_list([body_steps.plan_term(ctx.agent, p) for p in plans])):
        return False
    return labels is None or ctx.unify(labels, make_list([ctx.agent.library.label(p) for p in plans]))


@internal_action(".relevant_plan", arity=2, backtracks=True, pure=True)
def relevant_plan(ctx: Context, event: Term, target: Term) -> Iterator[None]:
    """``.relevant_plan({T}, P)``: *P* is a plan for an event; one answer for each."""
    for plan in _relevant(ctx, event):
        if ctx.unify(target, body_steps.plan_term(ctx.agent, plan)):
            yield


@internal_action(".list_plans", arity=(0, 1))
def list_plans(ctx: Context, event: Term = None) -> None:
    """``.list_plans [({T})]`` prints the plans."""
    for plan in ctx.agent.library.plans if event is None else _relevant(ctx, event):
        ctx.architecture.print(plan_text(body_steps.plan_term(ctx.agent, plan)))


@internal_action(".list_files", arity=(2, 3), restricted=0)
def list_files(ctx: Context, folder: Term, *rest: Term) -> bool:
    """``.list_files(Folder[, Regex], L)``: *L* is the sorted list of the files in a folder and its subfolders.

    They are strings, paths that begin with *Folder*. With *Regex*, only paths that it matches as a whole are included. A
    relative folder is relative to the project.

    Raises:
        ActionError: the folder cannot be read.
    """
    path = string(folder, "the first argument of .list_files")
    pattern = string(rest[0], "the second argument of .list_files") if len(rest) == 2 else None
    try:
        found = ctx.architecture.system.list_files(path)
        if pattern is not None:
            found = [name for name in found if matches_whole(pattern, name)]
    except OSError as fault:
        raise ActionError(f".list_files: cannot read {path}: {fault.strerror or fault}") from fault
    except ValueError as fault:
        raise WrongArguments(f".list_files: {fault}") from fault
    return ctx.unify(rest[-1], make_list([String(name) for name in found]))


@internal_action(".save_agent", arity=(1, 2), restricted=0)
def save_agent(ctx: Context, file: Term, goals: Term = None) -> None:
    """``.save_agent(File[, Goals])`` writes the beliefs, rules and plans of the agent as a program.

    *Goals* is a list of initial goals for the program. A relative path is relative to the project's folder.

    Raises:
        ActionError: the file cannot be written.
    """
    wanted = [] if goals is None else elements(goals, "the second argument of .save_agent")
    path = characters(file)
    try:
        ctx.architecture.system.write_file(path, _program_text(ctx.agent, wanted))
    except OSError as fault:
        raise ActionError(f".save_agent: cannot write {path}: {fault.strerror or fault}") from fault


def _program_text(agent: Circumstance, goals: list[Term]) -> str:
    """Return the beliefs and plans of an agent as a program, with initial goals."""
    known = knowledge(agent)
    parts = [
        "// beliefs and rules",
        *(
            _belief_text(symbol, entry, annotations)
            for symbol, rows, late in known["beliefs"]
            for entry, annotations in (*reversed(rows), *late)
        ),
        "",
        "// initial goals",
        *(f"!{text(goal)}." for goal in goals),
        "",
        "// functions",
        *(
            f'{{ register_function("{name}", {function.arity}, "{function.implementation}") }}'
            for name, function in known["functions"].items()
        ),
        "",
        "// plans",
        *(format_plan(plan.node) for plan in agent.library.plans),
    ]
    return "\n".join(parts) + "\n"


def _belief_text(symbol: Functor, entry: Any, annotations: tuple[Term, ...]) -> str:
    """Format a rule, or a belief without its default source."""
    if isinstance(entry, Rule):
        return f"{format_term(entry.node)}."
    belief = literal(symbol, entry, annotations) if isinstance(entry, tuple) else entry.head()
    kept = tuple(each for each in annotations if each != SOURCE_SELF)
    return f"{text(Annotated(bare(belief), kept) if kept else bare(belief))}."


@internal_action(".include", arity=(1, 2), brings_in=True, changes_plans=True, restricted=0)
def include(ctx: Context, file: Term, namespace: Term = None) -> bool:
    """``.include(File[, Namespace])`` adds the beliefs, goals and plans of a program file.

    With a namespace (an atom; a variable is bound to a new one) all of it is put there.

    Raises:
        ActionError: the file does not exist, or its program has errors.
    """
    path = string(file, "the first argument of .include")
    if namespace is not None and not isinstance(namespace, (Functor, Var)):
        raise WrongArguments(f"a namespace must be an atom or a variable, not {text(namespace)}")
    fresh = namespace.__class__ is Var
    name: str = ctx.agent.fresh_namespace() if fresh else getattr(namespace, "name", "default")
    try:
        ctx.agent.include(path, None if name == "default" else name)
    except FileNotFoundError as fault:
        raise ActionError(f".include: file {path} not found") from fault
    except (OSError, UnicodeError, JacarosError) as fault:
        raise ActionError(f".include: cannot include {path}: {fault}") from fault
    return not fresh or ctx.unify(namespace, atom(name))
