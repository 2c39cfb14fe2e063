"""Internal actions on the plan library and program files."""

from collections.abc import Iterator
from typing import Any

from jacaros.agents.language.diagnostics import AslError
from jacaros.agents.language.lowering import NotAPlan, format_plan, format_term
from jacaros.agents.mind.actions.internal_action import (
    ActionError,
    WrongArguments,
    characters,
    elements,
    internal_action,
    string,
)
from jacaros.agents.mind.actions.strings import matches_whole
from jacaros.agents.mind.rules import plan_terms
from jacaros.agents.mind.rules.context import Context
from jacaros.agents.mind.state.belief_base import literal
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.plan import Plan, Rule
from jacaros.agents.mind.storage import knowledge
from jacaros.agents.terms.text import plan_text, text
from jacaros.agents.terms.values import (
    SELF,
    SOURCE_SELF,
    Annotated,
    Functor,
    String,
    Term,
    Var,
    atom,
    bare,
    is_list,
    list_items,
    make_list,
)
from jacaros.errors import JacarosError


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
            (label, ctx.agent.library.label(plan)), (target, plan_terms.plan_term(ctx.agent, plan))
        ):
            yield


def _relevant(ctx: Context, event: Term) -> list[Plan]:
    plans = plan_terms.relevant_plans(ctx.agent, event)
    if plans is None:
        raise WrongArguments(f"expected an event such as {{+!g}}, found {text(event)}")
    return plans


@internal_action(".relevant_plans", arity=(2, 3), pure=True)
def relevant_plans(ctx: Context, event: Term, target: Term, labels: Term = None) -> bool:
    """``.relevant_plans({T}, Ps [,Labels])``: *Ps* is the list of the plans whose triggers unify with an event, in
    order.
    """
    plans = _relevant(ctx, event)
    if not ctx.unify(target, make_list([plan_terms.plan_term(ctx.agent, p) for p in plans])):
        return False
    return labels is None or ctx.unify(labels, make_list([ctx.agent.library.label(p) for p in plans]))


@internal_action(".relevant_plan", arity=2, backtracks=True, pure=True)
def relevant_plan(ctx: Context, event: Term, target: Term) -> Iterator[None]:
    """``.relevant_plan({T}, P)``: *P* is a plan for an event; one answer for each."""
    for plan in _relevant(ctx, event):
        if ctx.unify(target, plan_terms.plan_term(ctx.agent, plan)):
            yield


@internal_action(".list_plans", arity=(0, 1))
def list_plans(ctx: Context, event: Term = None) -> None:
    """``.list_plans [({T})]`` prints the plans."""
    for plan in ctx.agent.library.plans if event is None else _relevant(ctx, event):
        ctx.architecture.print(plan_text(plan_terms.plan_term(ctx.agent, plan)))


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
