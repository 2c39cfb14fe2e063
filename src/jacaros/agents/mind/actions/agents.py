"""Internal actions on the agent system: messages, agents and their services, random numbers, output and explanations.

A service is a string; other terms are converted to text. Types of services are accepted and ignored, as in Jason's local
infrastructure. The directory is an agent, ``df``, created on first use. Random numbers come from the agent's own
generator, so a run with a seed is reproducible.
"""

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from itertools import count
from typing import Any

from jacaros.agents.mind.actions.internal_action import (
    ActionError,
    FixedArguments,
    Function,
    WrongArguments,
    characters,
    elements,
    internal_action,
    number,
    string,
    whole,
)
from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules.context import Context
from jacaros.agents.mind.rules.pending import set_alarm
from jacaros.agents.mind.rules.proc_msg import nobody_there, time_out_question
from jacaros.agents.mind.state.act import SpeechAct
from jacaros.agents.mind.state.intention import variables_of
from jacaros.agents.mind.state.pending import ASK, AnswerWait, Waiting
from jacaros.agents.terms.substitution import is_flat, rename, resolve
from jacaros.agents.terms.text import display, text
from jacaros.agents.terms.values import (
    FALSE,
    NIL,
    NUMBERS,
    TRUE,
    Functor,
    String,
    Term,
    Var,
    arguments_of,
    atom,
    bare,
    functor,
    functor_of,
    is_list,
    list_items,
    make_list,
    structure,
)
from jacaros.runtime.errors import JacarosError, UsageError
from jacaros.version import VERSION

ERROR = functor("error", 1)
QUESTIONS = ("askOne", "askAll", "askHow", "ask-one", "ask-all", "ask-how")
_CLASSES = ("agentClass", "agentArchClass", "beliefBaseClass")


def _name(term: Term, what: str) -> str:
    term = bare(term)
    if term.__class__ is String:
        return str(term)
    if term.__class__ is Functor:
        return term.name.strip("'")
    raise WrongArguments(f"{what} must be an atom or a string, not {text(term)}")


def _say(
    agent: Mind,
    receiver: str,
    performative: str,
    content: Term,
    reply: str | None = None,
    message_id: str | int | None = None,
) -> None:
    """Send a message to one agent; bindings in its content may not be applied yet."""
    if message_id is None:
        agent.messages = message_id = agent.messages + 1
    sender = agent.name
    target = sender if receiver == "self" else receiver
    flat = is_flat(content)
    if not flat:
        content = rename(content)
        flat = is_flat(content)
    message = SpeechAct(
        performative, "self" if target == sender else sender, target, content, message_id, reply, flat
    )
    if not agent.architecture.send(message):
        raise _nobody(receiver)


def _nobody(receiver: str) -> ActionError:
    return ActionError(*nobody_there(receiver))


def _direct(written: FixedArguments) -> Function | None:
    """Return a specialised function for a ``.send`` with a constant performative (the usual case), and perhaps a
    constant receiver.
    """
    if len(written) != 3 or written[1] is None:
        return None
    act, to = _known_name(written[1]), _known_name(written[0])
    if act is None or (to is None and written[0] is not None):
        return None

    def send_to(agent: Mind, receiver: Term, performative: Term, content: Term) -> None:
        for name in (to,) if to is not None else _receivers(resolve(receiver)):
            _say(agent, name, act, content)

    return send_to


def _known_name(term: Term | None) -> str | None:
    if term is None or is_list(term) or bare(term).__class__ not in (String, Functor):
        return None
    return _name(term, "")


def _receivers(receiver: Term) -> list[str]:
    if is_list(receiver):
        return [_name(r, "a receiver") for r in list_items(receiver)]
    return [_name(receiver, "the receiver")]


@internal_action(".send", arity=(3, 5), suspends=True, direct=_direct, body_only=True, performative=1)
def send(ctx: Context, receiver: Term, performative: Term, content: Term, *rest: Term) -> Waiting | None:
    """``.send(To, Performative, Content [, Answer [, Timeout]])`` sends a message; with *Answer*, it is a synchronous
    question.

    *To* is a name or a list of names, which may be empty. *Timeout* is in milliseconds; when it expires, the
    answer is
    ``timeout``.

    Raises:
        ActionError: ``receiver_not_found``.
    """
    act = _name(performative, "the performative")
    receivers = _receivers(receiver)
    if act in QUESTIONS and rest:
        return _ask(ctx, receivers, act, content, rest, is_list(receiver))
    reply = _name(rest[0], "the message id") if rest and rest[0].__class__ is not Var else None
    for name in receivers:
        _say(ctx.agent, name, act, content, reply)
    return None


def _ask(
    ctx: Context, receivers: list[str], act: str, content: Term, rest: tuple[Term, ...], many: bool
) -> Waiting | None:
    if not receivers:
        if not ctx.unify(rest[0], NIL):
            raise ActionError("the answer does not match", (ERROR, atom("ask_failed")))
        return None
    waiting = AnswerWait(ctx.suspendable(), ASK, target=rest[0], many=many, expected=len(receivers))
    for name in receivers:
        message_id = ctx.agent.next_message_id()
        waiting.ids.append(message_id)
        ctx.agent.waits.questions[message_id] = waiting
        _say(ctx.agent, name, act, content, None, message_id)
    if len(rest) > 1:
        if rest[1].__class__ is not float:
            raise WrongArguments(f"the timeout must be a number of milliseconds, not {text(rest[1])}")
        waiting.pending.append(set_alarm(ctx.agent, rest[1] / 1000.0, time_out_question, waiting))
    return waiting


@internal_action(".broadcast", arity=2, suspends=True, body_only=True, performative=0)
def broadcast(ctx: Context, performative: Term, content: Term) -> None:
    """``.broadcast(Performative, Content)`` sends a message to all other agents."""
    act = _name(performative, "the performative")
    for name in ctx.architecture.system.agent_names():
        if name != ctx.agent.name:
            _say(ctx.agent, name, act, content)


@internal_action(".my_name", arity=1, pure=True)
def my_name(ctx: Context, name: Term) -> bool:
    """``.my_name(N)``: *N* is the agent's name, an atom."""
    return ctx.unify(name, atom(ctx.agent.name))


@internal_action(".all_names", arity=1, pure=True)
def all_names(ctx: Context, names: Term) -> bool:
    """``.all_names(L)``: *L* is the list of the names of all agents, as atoms, in order of creation."""
    return ctx.unify(names, make_list([atom(name) for name in ctx.architecture.system.agent_names()]))


@internal_action(".create_agent", arity=(1, 3), brings_in=True, restricted=2)
def create_agent(ctx: Context, name: Term, source: Term = None, options: Term = None) -> bool:
    """``.create_agent(Name[, File[, Options]])`` creates an agent that runs a program (default ``Name.asl``).

    The name is made unique. If the name is a variable, it is bound to the final name, a string: the variable's own name
    in lower case, with a number if necessary. *Options* is a list with ``agentClass("my.Careful(3)")``, a class in the
    project's Python code. Jason's ``agentArchClass`` and ``beliefBaseClass`` have no effect.

    Raises:
        ActionError: the agent could not be created, for example because its program has errors.
    """
    path = None if source is None else string(source, "the second argument of .create_agent")
    listed = [] if options is None else elements(options, "the third argument of .create_agent")
    classes = dict(map(_class_option, listed))
    make = ctx.architecture.system.create_agent
    return _made(ctx, ".create_agent", name, lambda wanted: make(wanted, path, classes))


def _made(ctx: Context, action: str, name: Term, make: Callable[[str], str | None]) -> bool:
    """Create an agent, whose name may be a variable."""
    variable = isinstance(name, Var)
    wanted = name.name[:1].lower() + name.name[1:] if variable else characters(name)
    made = make(wanted)
    if made is None:
        raise ActionError(f"{action}: agent {wanted} could not be created")
    return not variable or ctx.unify(String(made), name)


def _class_option(option: Term) -> tuple[str, str]:
    symbol = functor_of(option)
    if symbol is None or symbol.name not in _CLASSES or len(arguments_of(option)) != 1:
        raise WrongArguments(f".create_agent: unknown option {text(option)}")
    return symbol.name, characters(arguments_of(option)[0])


@internal_action(".clone", arity=1, brings_in=True)
def clone(ctx: Context, name: Term) -> bool:
    """``.clone(Name)`` creates an agent with the same beliefs, rules, plans, events and intentions.

    The calling intention and waiting intentions are not copied. The name is made unique; a variable is bound to the
    final name, as by ``.create_agent``.

    Raises:
        ActionError: the agent could not be created.
    """
    make, original = ctx.architecture.system.clone_agent, ctx.agent.name
    return _made(ctx, ".clone", name, lambda wanted: make(original, wanted))


@internal_action(".kill_agent", arity=(1, 2))
def kill_agent(ctx: Context, name: Term, deadline: Term = 0.0) -> bool:
    """``.kill_agent(Name[, Ms])`` ends an agent, immediately or after *Ms* milliseconds. Fails if it does not exist.

    With a time, the agent first gets the event ``+jag_shutting_down(Ms)``, so that it can prepare.
    """
    delay = number(deadline, "the second argument of .kill_agent") / 1000
    return ctx.architecture.system.kill_agent(characters(name), max(delay, 0.0), ctx.agent.name)


@internal_action(".stopMAS", arity=(0, 2), suspends=True, body_only=True)
def stop_mas(ctx: Context, delay: Term = 0.0, code: Term = 0.0) -> None:
    """``.stopMAS([Ms[, Code]])`` ends the whole run after *Ms* milliseconds, with an exit code (default 0).

    With a time, all agents first get the event ``+jag_shutting_down(Ms)``, so that they can prepare.

    ``true`` and ``false`` in place of the code mean 0: there is no virtual machine to keep running.
    """
    milliseconds = number(delay, "the first argument of .stopMAS")
    exit_code = 0 if code is TRUE or code is FALSE else whole(code, "the second argument of .stopMAS")
    ctx.architecture.stop_system(max(milliseconds, 0.0) / 1000, exit_code)


@internal_action(".version", arity=1, pure=True)
def version(ctx: Context, result: Term) -> bool:
    """``.version(V)``: *V* is the version of JaCaROS, a string."""
    return ctx.unify(result, String(VERSION))


@internal_action(".df_register", arity=(1, 2))
def register_service(ctx: Context, service: Term, _kind: Term = None) -> None:
    """``.df_register(Service[, Type])`` registers a service that the agent provides; subscribers are notified."""
    ctx.architecture.system.services.register(ctx.agent.name, characters(service))


@internal_action(".df_deregister", arity=(1, 2))
def deregister_service(ctx: Context, service: Term, _kind: Term = None) -> None:
    """``.df_deregister(Service[, Type])`` removes the registration of a service."""
    ctx.architecture.system.services.deregister(ctx.agent.name, characters(service))


@internal_action(".df_search", arity=(2, 3), pure=True)
def find_providers(ctx: Context, service: Term, *rest: Term) -> bool:
    """``.df_search(Service[, Type], L)``: *L* is the list of the agents that provide a service, as atoms."""
    found = ctx.architecture.system.services.providers(characters(service))
    return ctx.unify(rest[-1], make_list([atom(name) for name in found]))


@internal_action(".df_subscribe", arity=(1, 2))
def subscribe_to_service(ctx: Context, service: Term, _kind: Term = None) -> None:
    """``.df_subscribe(Service[, Type])`` subscribes to a service: ``df`` sends a belief ``provider(Agent, Service)`` for
    each present and future provider.
    """
    ctx.architecture.system.services.subscribe(ctx.agent.name, characters(service))


@internal_action(".random", arity=(1, 3), backtracks=True)
def random(ctx: Context, first: Term, second: Term = 1.0, third: Term = 1.0) -> Iterator[None]:
    """``.random(X[, N])``: *X* is a number from 0 (inclusive) to 1 (exclusive).

    ``.random(L, X[, N])``: *X* is an element of the list *L*; fails for an empty list.

    There are *N* answers (default 1), or infinitely many if *N* is 0.
    """
    generator = ctx.architecture.random
    choices = elements(first, "the list of .random") if is_list(first) else None
    result, amount = (first, second) if choices is None else (second, third)
    if result.__class__ is not Var:
        raise WrongArguments(
            f".random expects a list or a variable, and a variable after a list, not {text(result)}"
        )
    draws = 1 if amount == 1.0 else whole(amount, "the number of answers of .random")
    if choices == []:
        return
    for _ in range(draws) if draws else count():
        if ctx.unify(result, generator.random() if choices is None else generator.choice(choices)):
            yield


@internal_action(".set_random_seed", arity=1)
def set_random_seed(ctx: Context, seed: Term) -> None:
    """``.set_random_seed(N)`` seeds the agent's random number generator."""
    ctx.architecture.random.seed(whole(seed, "the argument of .set_random_seed"))


# Internal actions for output, and for explanations.

_LEVELS = {"severe": "error", "warning": "warning", "fine": "debug", "finer": "debug", "finest": "debug"}
_EXPRESSION = re.compile(r"#\{([^{}]+)\}")


@internal_action(".print", prints=True)
@internal_action(".println", prints=True)
def print_(ctx: Context, *arguments: Term) -> None:
    """``.print(A, ...)`` and ``.println(A, ...)`` print their arguments joined without separators.

    Strings are printed without quotes, strings inside other terms with quotes, unbound variables as ``X<no-value>``.
    Line breaks in strings are kept.
    """
    ctx.architecture.print("".join(map(display, arguments)))


@internal_action(".printf", arity=(1, None), prints=True)
def printf(ctx: Context, template: Term, *arguments: Term) -> None:
    """``.printf(Format, A, ...)`` prints a text made with a Java format such as ``%8.2f``.

    Numbers are doubles: use ``%.0f`` instead of ``%d``. See `java_format` for the supported conversions.

    Raises:
        ActionError: the format is invalid or does not fit the arguments.
    """
    from jacaros.agents.mind.actions.java_format import (
        java_format,  # imported here: few programs use it, and it needs decimal
    )

    pattern = string(template, "the first argument of .printf")
    try:
        shown = java_format(pattern, [_value(argument) for argument in arguments])
    except ValueError as error:
        raise ActionError(f".printf: {error}") from None
    ctx.architecture.print(shown)


def _value(term: Term) -> float | str | bool:
    if term is TRUE or term is FALSE:
        return term is TRUE
    return term if term.__class__ in NUMBERS else display(term)


@internal_action(".puts", arity=(1, 2), prints=True, by_name=True)
def puts(ctx: Context, template: Term, result: Term = None) -> bool:
    """``.puts(Text[, Result])`` prints a text in which every ``#{expression}`` is replaced by its value.

    Expressions that do not parse as terms are left as they are. With an unbound *result*, nothing is printed: the text
    becomes its value. If *result* is a string, it is appended to the text.
    """
    filled = _fill(ctx, string(template, "the first argument of .puts"))
    if result.__class__ is Var:
        return ctx.unify(String(filled), result)
    if result.__class__ is String:
        filled += _fill(ctx, result)
    ctx.architecture.print(filled)
    return True


def _fill(ctx: Context, template: str) -> str:
    def value(match: re.Match[str]) -> str:
        try:
            return characters(resolve(ctx.parse_term(match.group(1))))
        except JacarosError:
            return match.group()

    return _EXPRESSION.sub(value, template)


@internal_action(".log", arity=(1, None), prints=True)
def log(ctx: Context, level: Term, *arguments: Term) -> None:
    """``.log(Level, A, ...)`` logs a message, separate from the program's output.

    *level* is ``severe``, ``warning``, ``info``, ``fine``, ``finer``, ``finest``; other atoms mean ``info``.
    """
    if not isinstance(level, Functor):
        raise WrongArguments(f"the first argument of .log must be a level such as info, not {text(level)}")
    ctx.architecture.log(_LEVELS.get(level.name, "info"), "".join(map(display, arguments)))


@internal_action(".verbose", arity=1)
def verbose(ctx: Context, level: Term) -> None:
    """``.verbose(N)`` sets how much is logged about the agent from now on: 0 only problems, 1 the default, 2 details as
    well.
    """
    wanted = whole(level, "the argument of .verbose")
    if not 0 <= wanted <= 2:
        raise WrongArguments(f"the argument of .verbose must be 0, 1 or 2, not {text(level)}")
    ctx.agent.options = replace(ctx.agent.options, verbose=wanted)


@internal_action(".print_unifier", arity=0, by_name=True)
def print_unifier(ctx: Context) -> None:
    """``.print_unifier`` prints the bound variables of the plan, one per line, and ``done``."""
    if ctx.intention is not None:
        for name, value in variables_of(ctx.intention.frames[-1]).items():
            value = resolve(value)
            if value.__class__ is not Var:
                ctx.architecture.print(f"{name}={text(value)}")
    ctx.architecture.print("done")


# The internal action ``.why``: an agent's question about its own run, answered as terms.


NEVER = atom("never")
"""The time of something that never happened or has no time."""


@internal_action(".why", arity=2)
def why(ctx: Context, question: Term, answer: Term) -> bool:
    """``.why(Q, A)``: A is ``explanation(Text, Time, Facts, Causes)``.

    Raises:
        ActionError: the question is invalid.
    """
    try:
        found = ctx.architecture.system.explain(written_question(question), ctx.agent.name)
    except UsageError as refused:
        raise ActionError(str(refused).partition("\n")[0].removeprefix("error: ")) from None
    return ctx.unify(answer, _explanation(found))


def written_question(question: Term) -> str:
    """Return the question that a term asks, such as ``stopped``, ``"+alarm(_)"``, ``{ +alarm(_) }`` or ``plan(low)``."""
    if question.__class__ is String:
        return str(question)
    kind, arguments = functor_of(question), arguments_of(question)
    if kind is not None and len(arguments) == 1 and kind.name in ("belief", "plan", "command", "operation"):
        about = arguments[0]
        named = str(about) if about.__class__ is String else _text(about)
        return f"{kind.name} {'@' if kind.name == 'plan' and about.__class__ is Functor else ''}{named}"
    return _text(question).strip("{} ")


def _text(term: Term) -> str:
    """Return a term as text, without the numbers of its unnamed variables."""
    return re.sub(r"\b_\d+\b", "_", text(term))


def _explanation(found: Mapping[str, Any]) -> Term:
    facts, causes = (make_list(list(map(_fact, found[name]))) for name in ("facts", "because"))
    return structure("explanation", String(found["answer"]), _time(found["t"]), facts, causes)


def _fact(fact: Mapping[str, Any]) -> Term:
    place = structure("place", String(fact["file"]), float(fact["line"]))
    told = atom(fact["kind"]), _time(fact["t"]), String(fact["agent"]), String(fact["text"])
    return structure("fact", *told, place)


def _time(t: float | None) -> Term:
    return NEVER if t is None else float(t)
