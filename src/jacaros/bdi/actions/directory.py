"""Internal actions of the directory facilitator: who provides which service.

A service is a string; other terms are taken as written.  Types of services are accepted and not looked at, as in
Jason's local infrastructure.  The directory is an agent, ``df``, that exists from its first use on.
"""

from jacaros.bdi.actions.arguments import characters
from jacaros.bdi.actions.internal_action import internal_action
from jacaros.bdi.rules.context import Context
from jacaros.terms.values import Term, atom, make_list


@internal_action(".df_register", arity=(1, 2))
def register(ctx: Context, service: Term, kind: Term = None) -> None:
    """``.df_register(Service[, Type])``: the agent provides a service; subscribers are told."""
    del kind
    ctx.architecture.register_service(characters(service))


@internal_action(".df_deregister", arity=(1, 2))
def deregister(ctx: Context, service: Term, kind: Term = None) -> None:
    """``.df_deregister(Service[, Type])``: the agent does not provide it any more."""
    del kind
    ctx.architecture.deregister_service(characters(service))


@internal_action(".df_search", arity=(2, 3))
def search(ctx: Context, service: Term, *rest: Term) -> bool:
    """``.df_search(Service[, Type], L)``: *L* is the list of the agents that provide a service, atoms."""
    found = ctx.architecture.providers(characters(service))
    return ctx.unify(rest[-1], make_list([atom(name) for name in found]))


@internal_action(".df_subscribe", arity=(1, 2))
def subscribe(ctx: Context, service: Term, kind: Term = None) -> None:
    """``.df_subscribe(Service[, Type])``: the agent is told ``provider(Agent, Service)`` of each provider by ``df``,
    those of now and those to come."""
    del kind
    ctx.architecture.subscribe_to_service(characters(service))
