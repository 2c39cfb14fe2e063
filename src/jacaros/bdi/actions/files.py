"""Internal actions on files: programs that are included, saved, and looked for."""

from typing import Any

from jacaros.asl.formatter import format_plan, format_term
from jacaros.bdi.actions.internal_action import (
    ActionError,
    WrongArguments,
    characters,
    elements,
    internal_action,
    string,
)
from jacaros.bdi.actions.java_regex import matches_whole
from jacaros.bdi.rules.context import Context
from jacaros.bdi.snapshot import knowledge
from jacaros.bdi.state.belief_base import literal
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.rule import Rule
from jacaros.errors import JacarosError
from jacaros.terms.text import text
from jacaros.terms.values import (
    SOURCE_SELF,
    Annotated,
    Functor,
    String,
    Term,
    Var,
    atom,
    bare,
    make_list,
)


@internal_action(".list_files", arity=(2, 3), restricted=0)
def list_files(ctx: Context, folder: Term, *rest: Term) -> bool:
    """``.list_files(Folder[, Regex], L)``: *L* is the sorted list of the files in a folder and the folders in it.

    They are strings, paths that begin with *Folder*.  With *Regex*, only those that it matches as a whole.  A
    folder that is not absolute is one of the project.

    Raises:
        WrongArguments: the folder or the regular expression is no string, or it is wrong.
        ActionError: the folder cannot be read.
    """
    path = string(folder, "the first argument of .list_files")
    pattern = string(rest[0], "the second argument of .list_files") if len(rest) == 2 else None
    try:
        found = ctx.architecture.list_files(path)
        if pattern is not None:
            found = [name for name in found if matches_whole(pattern, name)]
    except OSError as fault:
        raise ActionError(f".list_files: {path} cannot be read: {fault.strerror or fault}") from fault
    except ValueError as fault:
        raise WrongArguments(f".list_files: {fault}") from fault
    return ctx.unify(rest[-1], make_list([String(name) for name in found]))


@internal_action(".save_agent", arity=(1, 2), restricted=0)
def save_agent(ctx: Context, file: Term, goals: Term = None) -> None:
    """``.save_agent(File[, Goals])`` writes the beliefs, rules and plans of the agent as a program.

    *Goals* is a list of the initial goals that the program is to have.  A path that is not absolute is one of
    the project's folder.

    Raises:
        WrongArguments: *Goals* is no list.
        ActionError: the file cannot be written.
    """
    wanted = [] if goals is None else elements(goals, "the second argument of .save_agent")
    path = characters(file)
    try:
        ctx.architecture.write_file(path, _program_text(ctx.agent, wanted))
    except OSError as fault:
        raise ActionError(f".save_agent: {path} cannot be written: {fault.strerror or fault}") from fault


def _program_text(agent: Circumstance, goals: list[Term]) -> str:
    """What an agent knows, with initial goals."""
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
    """A rule; or a belief without its own source, which a program's beliefs get anyway."""
    if isinstance(entry, Rule):
        return f"{format_term(entry.node)}."
    belief = literal(symbol, entry, annotations) if isinstance(entry, tuple) else entry.head()
    kept = tuple(each for each in annotations if each != SOURCE_SELF)
    return f"{text(Annotated(bare(belief), kept) if kept else bare(belief))}."


@internal_action(".include", arity=(1, 2), brings_in=True, changes_plans=True, restricted=0)
def include(ctx: Context, file: Term, namespace: Term = None) -> bool:
    """``.include(File[, Namespace])`` takes the beliefs, goals and plans of a program file in.

    With a namespace (an atom; a variable is bound to a new one) all of it is put there.

    Raises:
        WrongArguments: *File* is no string, or the namespace is neither atom nor variable.
        ActionError: the file is not there, or its program is wrong.
    """
    path = string(file, "the first argument of .include")
    if namespace is not None and not isinstance(namespace, (Functor, Var)):
        raise WrongArguments(f"a namespace is an atom or a variable, not {text(namespace)}")
    fresh = namespace.__class__ is Var
    name: str = ctx.agent.fresh_namespace() if fresh else getattr(namespace, "name", "default")
    try:
        ctx.agent.include(path, None if name == "default" else name)
    except FileNotFoundError as fault:
        raise ActionError(f".include: the file {path} is not found") from fault
    except (OSError, UnicodeError, JacarosError) as fault:
        raise ActionError(f".include: {path} cannot be included: {fault}") from fault
    return not fresh or ctx.unify(namespace, atom(name))
