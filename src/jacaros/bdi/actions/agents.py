"""Internal actions on the system of agents and its services, and chance.

A service is a string; other terms are taken as written.  Types of services are accepted and ignored, as in Jason's local
infrastructure.  The directory is an agent, ``df``, that exists from its first use on.  Random numbers come from the agent's
own generator: a run with a seed repeats itself.
"""

from collections.abc import Iterator
from itertools import count

from jacaros.bdi.actions.internal_action import (
    ActionError,
    WrongArguments,
    characters,
    elements,
    internal_action,
    number,
    string,
    whole,
)
from jacaros.bdi.rules.context import Context
from jacaros.terms.text import text
from jacaros.terms.values import (
    FALSE,
    TRUE,
    String,
    Term,
    Var,
    arguments_of,
    atom,
    functor_of,
    is_list,
    make_list,
)
from jacaros.version import VERSION

_CLASSES = ("agentClass", "agentArchClass", "beliefBaseClass")


@internal_action(".my_name", arity=1, repeatable=True)
def my_name(ctx: Context, name: Term) -> bool:
    """``.my_name(N)``: *N* is the agent's name, an atom."""
    return ctx.unify(name, atom(ctx.agent.name))


@internal_action(".all_names", arity=1)
def all_names(ctx: Context, names: Term) -> bool:
    """``.all_names(L)``: *L* is the list of the names of all agents, atoms, in the order of their making."""
    return ctx.unify(names, make_list([atom(name) for name in ctx.architecture.agent_names()]))


@internal_action(".create_agent", arity=(1, 3), brings_in=True, restricted=2)
def create_agent(ctx: Context, name: Term, source: Term = None, options: Term = None) -> bool:
    """``.create_agent(Name[, File[, Options]])`` makes an agent that runs a program (default ``Name.asl``).

    The name is made unique.  A variable for the name is bound to the final one, a string: its own name in
    small letters, with a number if need be.  *Options* is a list of ``agentClass("my.Careful")``,
    ``agentArchClass("my.Arch")`` and ``beliefBaseClass("my.LoudBB(3)")``, classes of the project's Python code.

    Raises:
        ActionError: the agent could not be made, because of its program for example.
    """
    path = None if source is None else string(source, "the second argument of .create_agent")
    listed = [] if options is None else elements(options, "the third argument of .create_agent")
    classes = dict(map(_class_option, listed))
    wanted = _name_from_variable(name) if isinstance(name, Var) else characters(name)
    made = ctx.architecture.create_agent(wanted, path, classes)
    if made is None:
        raise ActionError(f".create_agent: the agent {wanted} could not be made")
    return not isinstance(name, Var) or ctx.unify(String(made), name)


def _name_from_variable(variable: Var) -> str:
    return variable.name[:1].lower() + variable.name[1:]


def _class_option(option: Term) -> tuple[str, str]:
    symbol = functor_of(option)
    if symbol is None or symbol.name not in _CLASSES or len(arguments_of(option)) != 1:
        raise WrongArguments(f".create_agent does not know the option {text(option)}")
    return symbol.name, characters(arguments_of(option)[0])


@internal_action(".clone", arity=1, brings_in=True)
def clone(ctx: Context, name: Term) -> bool:
    """``.clone(Name)`` makes an agent with the same beliefs, rules, plans, events and intentions.

    The calling intention is not copied, nor are intentions that wait for something.  The name is made unique; a
    variable is bound to the final one, as by ``.create_agent``.

    Raises:
        ActionError: the agent could not be made.
    """
    wanted = _name_from_variable(name) if isinstance(name, Var) else characters(name)
    made = ctx.architecture.clone_agent(wanted)
    if made is None:
        raise ActionError(f".clone: the agent {wanted} could not be made")
    return not isinstance(name, Var) or ctx.unify(String(made), name)


@internal_action(".kill_agent", arity=(1, 2))
def kill_agent(ctx: Context, name: Term, deadline: Term = 0.0) -> bool:
    """``.kill_agent(Name[, Ms])`` ends an agent, at once or after some milliseconds.  Fails if there is none.

    With a time, the agent is given ``+jag_shutting_down(Ms)`` so that it can prepare.
    """
    delay = number(deadline, "the second argument of .kill_agent") / 1000
    return ctx.architecture.kill_agent(characters(name), max(delay, 0.0))


@internal_action(".stopMAS", arity=(0, 2), suspends=True, body_only=True)
def stop_mas(ctx: Context, delay: Term = 0.0, code: Term = 0.0) -> None:
    """``.stopMAS([Ms[, Code]])`` ends the whole run after some milliseconds, with an exit code (default 0).

    With a time, all agents are given ``+jag_shutting_down(Ms)`` so that they can prepare.

    ``true`` and ``false`` in place of the code stand for 0: there is no virtual machine to be kept running.
    """
    milliseconds = number(delay, "the first argument of .stopMAS")
    exit_code = 0 if code is TRUE or code is FALSE else whole(code, "the second argument of .stopMAS")
    ctx.architecture.stop_system(max(milliseconds, 0.0) / 1000, exit_code)


@internal_action(".version", arity=1)
def version(ctx: Context, result: Term) -> bool:
    """``.version(V)``: *V* is the version of JaCaROS, a string."""
    return ctx.unify(result, String(VERSION))


@internal_action(".df_register", arity=(1, 2))
def register_service(ctx: Context, service: Term, kind: Term = None) -> None:
    """``.df_register(Service[, Type])``: the agent provides a service; subscribers are told."""
    del kind
    ctx.architecture.register_service(characters(service))


@internal_action(".df_deregister", arity=(1, 2))
def deregister_service(ctx: Context, service: Term, kind: Term = None) -> None:
    """``.df_deregister(Service[, Type])``: the agent does not provide it any more."""
    del kind
    ctx.architecture.deregister_service(characters(service))


@internal_action(".df_search", arity=(2, 3))
def find_providers(ctx: Context, service: Term, *rest: Term) -> bool:
    """``.df_search(Service[, Type], L)``: *L* is the list of the agents that provide a service, atoms."""
    found = ctx.architecture.providers(characters(service))
    return ctx.unify(rest[-1], make_list([atom(name) for name in found]))


@internal_action(".df_subscribe", arity=(1, 2))
def subscribe_to_service(ctx: Context, service: Term, kind: Term = None) -> None:
    """``.df_subscribe(Service[, Type])``: the agent is told ``provider(Agent, Service)`` of each provider by ``df``,
    those of now and those to come."""
    del kind
    ctx.architecture.subscribe_to_service(characters(service))


@internal_action(".random", arity=(1, 3), backtracks=True)
def random(ctx: Context, first: Term, second: Term = 1.0, third: Term = 1.0) -> Iterator[None]:
    """``.random(X[, N])``: *X* is a number from 0 (inclusive) to 1 (exclusive).

    ``.random(L, X[, N])``: *X* is an element of the list *L*; fails for an empty list.

    There are *N* answers (default 1), endlessly many when it is 0.
    """
    generator = ctx.architecture.random
    choices = elements(first, "the list of .random") if is_list(first) else None
    result, amount = (first, second) if choices is None else (second, third)
    if result.__class__ is not Var:
        raise WrongArguments(
            f".random needs a list or a variable, and a variable behind a list, not {text(result)}"
        )
    draws = 1 if amount == 1.0 else whole(amount, "the number of answers of .random")
    if choices == []:
        return
    for _ in range(draws) if draws else count():
        if ctx.unify(result, generator.random() if choices is None else generator.choice(choices)):
            yield


@internal_action(".set_random_seed", arity=1)
def set_random_seed(ctx: Context, seed: Term) -> None:
    """``.set_random_seed(N)``: the agent's draws from now on follow from *N*."""
    ctx.architecture.random.seed(whole(seed, "the argument of .set_random_seed"))
