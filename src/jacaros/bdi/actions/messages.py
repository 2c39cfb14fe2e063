"""Internal actions that send messages."""

from jacaros.bdi.actions.internal_action import (
    ActionError,
    Function,
    Written,
    WrongArguments,
    internal_action,
)
from jacaros.bdi.mind import Mind
from jacaros.bdi.rules.context import Context
from jacaros.bdi.rules.proc_msg import nobody_there, time_out_question
from jacaros.bdi.rules.waits import set_alarm
from jacaros.bdi.state.speech_act import SpeechAct
from jacaros.bdi.state.waiting import AnswerWait, Waiting
from jacaros.terms.substitution import ATOMIC, is_flat, rename, resolve
from jacaros.terms.text import text
from jacaros.terms.values import (
    NIL,
    Functor,
    String,
    Term,
    Var,
    atom,
    bare,
    functor,
    is_list,
    list_items,
)

ERROR = functor("error", 1)
QUESTIONS = ("askOne", "askAll", "askHow", "ask-one", "ask-all", "ask-how")


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
    """Send a message to one agent; its content may have bindings that are not applied yet."""
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


def _direct(written: Written) -> Function | None:
    """A function for a ``.send`` whose performative is written out, as it nearly always is, and perhaps the receiver."""
    if len(written) != 3 or written[1] is None:
        return None
    act, to = _known_name(written[1]), _known_name(written[0])
    if act is None or (to is None and written[0] is not None):
        return None
    if to is None or to == "self":
        return _sender_to_some(act)
    return _sender_to_one(act, to, written[2] is not None and is_flat(written[2]))


def _sender_to_one(act: str, to: str, flat: bool) -> Function:
    """Sends to one agent that is written out; *flat* if the content is known to be."""

    def send_on(agent: Mind, receiver: Term, performative: Term, content: Term) -> None:
        # `_say` and `is_flat`, written out for the most frequent messages; the others are left to it.
        if not flat:
            if content.__class__ is not tuple or content[0].kind:
                _say(agent, to, act, content)
                return
            for part in content:
                if part.__class__ not in ATOMIC:
                    _say(agent, to, act, content)
                    return
        if to == agent.name:
            _say(agent, to, act, content)
            return
        agent.messages = number = agent.messages + 1
        if not agent.architecture.send(SpeechAct(act, agent.name, to, content, number, None, True)):
            raise _nobody(to)

    return send_on


def _sender_to_some(act: str) -> Function:
    """Sends to one or several agents that become known at run time, or to the agent itself."""

    def send_to(agent: Mind, receiver: Term, performative: Term, content: Term) -> None:
        for name in _receivers(resolve(receiver)):
            _say(agent, name, act, content)

    return send_to


def _known_name(term: Term | None) -> str | None:
    """The name that a term of the program is, if it is one."""
    if term is None or is_list(term) or bare(term).__class__ not in (String, Functor):
        return None
    return _name(term, "")


def _receivers(receiver: Term) -> list[str]:
    if is_list(receiver):
        return [_name(r, "a receiver") for r in list_items(receiver)]
    return [_name(receiver, "the receiver")]


@internal_action(".send", arity=(3, 5), suspends=True, direct=_direct, body_only=True, performative=1)
def send(ctx: Context, receiver: Term, performative: Term, content: Term, *rest: Term) -> Waiting | None:
    """``.send(To, Performative, Content [, Answer [, Timeout]])``: a message; with an answer, a synchronous question.

    *To* is a name or a list of names, which may be empty; *Timeout* is in milliseconds, and the answer is ``timeout``
    then.

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
            raise ActionError("the answer does not fit", (ERROR, atom("ask_failed")))
        return None
    waiting = AnswerWait(ctx.suspendable(), rest[0], many, len(receivers))
    for name in receivers:
        message_id = ctx.agent.next_message_id()
        waiting.ids.append(message_id)
        ctx.agent.waits.questions[message_id] = waiting
        _say(ctx.agent, name, act, content, None, message_id)
    if len(rest) > 1:
        if rest[1].__class__ is not float:
            raise WrongArguments(f"the time-out must be a number of milliseconds, not {text(rest[1])}")
        waiting.alarm = set_alarm(ctx.agent, rest[1] / 1000.0, time_out_question, waiting)
    return waiting


@internal_action(".broadcast", arity=2, suspends=True, body_only=True, performative=0)
def broadcast(ctx: Context, performative: Term, content: Term) -> None:
    """``.broadcast(Performative, Content)``: to all other agents."""
    act = _name(performative, "the performative")
    for name in ctx.architecture.agent_names():
        if name != ctx.agent.name:
            _say(ctx.agent, name, act, content)
