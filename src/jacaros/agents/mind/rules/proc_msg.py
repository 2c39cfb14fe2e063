"""What messages do (KQML as Jason defines it): tell, achieve, ask, and the rest."""

from collections.abc import Iterator
from functools import lru_cache
from typing import Any

from jacaros.agents.language.diagnostics import AslError
from jacaros.agents.language.lowering import fresh_names, lower_plan
from jacaros.agents.mind.rules import belief_update, deadlines, failure
from jacaros.agents.mind.rules.body_steps import relevant_plans
from jacaros.agents.mind.rules.deadlines import adopt
from jacaros.agents.mind.rules.failure_reason import FailureReason, lost_question
from jacaros.agents.mind.rules.query import solve_formula
from jacaros.agents.mind.rules.searching import run
from jacaros.agents.mind.state.act import SpeechAct
from jacaros.agents.mind.state.belief_base import is_source, parts, without_sources
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import FIRST_SLOT, STEP, Frame, Intention
from jacaros.agents.mind.state.pending import AnswerWait
from jacaros.agents.mind.state.plan import hidden_plan
from jacaros.agents.mind.state.triggers import Goal, Trigger, trigger
from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.substitution import is_flat, rename, resolve
from jacaros.agents.terms.text import text
from jacaros.agents.terms.unifier import undo
from jacaros.agents.terms.values import (
    BY_SELF,
    CONS,
    NIL,
    PLAIN,
    SOURCE,
    SOURCE_SELF,
    Annotated,
    Functor,
    Term,
    Var,
    annotations_of,
    arguments_of,
    atom,
    bare,
    deref,
    functor,
    functor_of,
    is_list,
    list_items,
    make_list,
)
from jacaros.runtime.errors import InternalError

ERROR = functor("error", 1)
_IMMEDIATE = frozenset({"tell", "achieve", "signal"})
"""Performatives whose only effect is an event, which takes its place in the queue."""
UNDELIVERED = functor("undelivered", 2)
"""Functor of the content of a message ``undelivered``: what was not delivered, and why."""
RECEIVED = trigger("+", "!", functor("kqml_received", 4))


def read_message(agent: Circumstance, message: SpeechAct) -> None:
    """Rule ProcMsg for a message whose turn it is."""
    observer = agent.observers.mind
    if observer is not None:
        observer.reads(message)
    try:
        if message.in_reply_to is not None and _answers_question(agent, message):
            pass
        elif agent.accepts(message):
            performative = message.performative
            waits_its_turn = performative not in _IMMEDIATE and (agent.events or agent.atomic is not None)
            if waits_its_turn or agent.library.selects[RECEIVED] is not None:
                _post(agent, message)
            else:
                _ACTIONS.get(performative, _warn_of)(agent, message)
    except InternalError:
        raise
    except Exception as fault:
        _skip(agent, message, fault)
    if observer is not None:
        observer.reads(None)


def _skip(agent: Circumstance, message: SpeechAct, fault: Exception) -> None:
    failure.report_skipped(agent, f"message ({message.performative}) from {message.sender}", fault)
    if message.performative.startswith("ask"):
        answer(agent, message, None)


def _post(agent: Circumstance, message: SpeechAct) -> None:
    """Post ``+!kqml_received`` for a message, in the order of the queue.

    As in Jason, plans of the program may handle it. Questions and the like are posted, too, because they must not overtake
    the effects of earlier messages, or see those of half an atomic plan.
    """
    sender, performative = atom(message.sender), atom(message.performative)
    goal: Goal = (RECEIVED, sender, performative, message.content, atom(message.id))
    agent.post((goal, None, BY_SELF, agent.cause_now()))


def receive_event(agent: Circumstance, goal: Goal) -> None:
    """Handle ``+!kqml_received(Sender, Performative, Content, Id)`` without a plan of the program for it."""
    sender, performative, content, id = goal[1:]
    message = SpeechAct(text(performative), text(sender), agent.name, content, text(id))
    try:
        _ACTIONS.get(message.performative, _warn_of)(agent, message)
    except InternalError:
        raise
    except Exception as fault:
        _skip(agent, message, fault)


def _warn_of(agent: Circumstance, message: SpeechAct) -> None:
    agent.architecture.log(
        "warning", f"unknown performative {message.performative} in a message from {message.sender}"
    )


def _answers_question(agent: Circumstance, message: SpeechAct) -> bool:
    """Return whether the message answers a question of the agent: it is passed to the asker, or discarded if none waits."""
    question = message.in_reply_to
    if question in agent.waits.questions:
        take_answer(agent, agent.waits.questions[question], message)
        return True
    if question in agent.waits.abandoned:
        agent.waits.abandoned.remove(question)
        return True
    return False


def take_answer(agent: Circumstance, waiting: AnswerWait, message: SpeechAct) -> None:
    """An answer to a question of this agent has come, or the question was not delivered."""
    agent.waits.questions.pop(str(message.in_reply_to), None)
    if message.performative == "undelivered":
        deadlines.forget(agent, waiting)
        deadlines.fail(agent, waiting, *not_delivered(message.sender, message.content[2]))
        return
    content = atom("false") if message.performative == "untell" else _with_source(agent, message)
    waiting.answers.append(content)
    if len(waiting.answers) == waiting.expected:
        _end_question(agent, waiting, make_list(waiting.answers) if waiting.many else content)


def time_out_question(agent: Circumstance, waiting: AnswerWait) -> None:
    """No answer came in time."""
    _end_question(agent, waiting, atom("timeout"))


def _end_question(agent: Circumstance, waiting: AnswerWait, value: Term) -> None:
    deadlines.forget(agent, waiting)
    if agent.context.unify(waiting.target, value):
        del agent.trail[:]
        deadlines.succeed(agent, waiting)
    else:
        deadlines.fail(agent, waiting, "the answer does not match", (ERROR, atom("ask_failed")))


def _with_source(agent: Circumstance, message: SpeechAct) -> Term:
    """The answer, every literal of it with the answering agent as source."""
    if is_list(message.content):
        return make_list([_told_by(item, agent.name, message) for item in list_items(message.content)])
    return _told_by(message.content, agent.name, message)


def _told_by(content: Term, own_name: str, message: SpeechAct) -> Term:
    sender = own_name if message.sender == "self" else message.sender
    symbol = functor_of(content)
    return from_sender(content, sender) if symbol is not None and symbol.kind == PLAIN else content


def nobody_there(receiver: str) -> tuple[str, Term]:
    """Describe why a message cannot be delivered: for the log, and as the error of the step."""
    return f"unknown receiver: '{receiver}'", (ERROR, atom("receiver_not_found"))


def not_delivered(receiver: str, reason: Term) -> tuple[str, Term]:
    """Describe why a message that was accepted did not arrive: for the log, and as the error of the step."""
    if reason is nobody_there(receiver)[1][1]:
        return nobody_there(receiver)
    return f"the question did not reach {receiver}: {text(reason)}", (ERROR, reason)


def from_sender(content: Term, sender: str) -> Term:
    """Return the content with ``source(sender)``; previous sources are nested inside."""
    content = resolve(content)
    inner = bare(content)
    others: list[Term] = []
    sources: list[Term] = []
    for annotation in annotations_of(content):
        (sources if is_source(annotation) else others).append(annotation)
    source: Term = (SOURCE, atom(sender))
    if sources and sources != [SOURCE_SELF]:
        source = Annotated(source, annotation_set(tuple(sources)))
    return Annotated(inner, annotation_set((*others, source)))


def literal_from(content: Term, sender: str) -> tuple[Functor | None, tuple[Term, ...], tuple[Term, ...]]:
    """Return functor, arguments and annotations of the content with ``source(sender)``; no functor if it is not a
    literal.
    """
    if is_flat(content):
        return functor_of(content), arguments_of(content), _only_from(sender)
    return parts(from_sender(content, sender))


@lru_cache(20_000)  # fewer than there are agents, and it would miss every time
def _only_from(sender: str) -> tuple[Term, ...]:
    """Return the annotations of what comes from one agent: one tuple for all its messages."""
    return ((SOURCE, atom(sender)),)


def _contents(content: Term) -> list[Term]:
    """The literals of a message: one, or those of a list."""
    content = deref(content)
    return list(list_items(content)) if is_list(content) else [content]


def _tell(agent: Circumstance, message: SpeechAct) -> None:
    if message.flat:
        # Most messages are flat, so nothing in them has to be resolved.
        content = message.content
        symbol, row = (content[0], content[1:]) if content.__class__ is tuple else (content, ())
        if symbol is not CONS and symbol is not NIL:
            agent.believe(symbol, row, _only_from(message.sender))  # type: ignore[attr-defined]
            return
    for content in _contents(message.content):
        if not agent.tell(from_sender(content, message.sender)):  # type: ignore[attr-defined]
            _refuse(agent, message)


def _untell(agent: Circumstance, message: SpeechAct) -> None:
    for content in _contents(message.content):
        agent.untell(from_sender(content, message.sender))  # type: ignore[attr-defined]


@lru_cache(1024)
def _achieved(symbol: Functor) -> Trigger:
    """Return the event kind of a goal that others have for an agent."""
    return trigger("+", "!", symbol)


def _achieve(agent: Circumstance, message: SpeechAct) -> None:
    if message.flat and not agent.features.meta:
        # As above.
        content = message.content
        symbol, row = (content[0], content[1:]) if content.__class__ is tuple else (content, ())
        if symbol is not CONS and symbol is not NIL:
            flat: Goal = (_achieved(symbol),) + row  # type: ignore[assignment]  # noqa: RUF005 - without a list in between
            agent.post((flat, None, _only_from(message.sender), None))
            return
    for content in _contents(message.content):
        symbol, arguments, annotations = literal_from(content, message.sender)
        if symbol is None:
            _refuse(agent, message)
        else:
            goal: Goal = (trigger("+", "!", symbol), *arguments)
            adopt(agent, (goal, None, annotations, agent.cause_now()))


def _unachieve(agent: Circumstance, message: SpeechAct) -> None:
    agent.drop_desire(message.content)  # type: ignore[attr-defined]


def _signal(agent: Circumstance, message: SpeechAct) -> None:
    for content in _contents(message.content):
        symbol, row, annotations = literal_from(content, message.sender)
        if symbol is None:
            _refuse(agent, message)
        else:
            marked = annotation_set((*annotations, atom("signal")))
            belief_update.raise_event(agent, trigger("+", "", symbol), row, marked, believed=False)


def _refuse(agent: Circumstance, message: SpeechAct) -> None:
    agent.architecture.log(
        "warning",
        f"content of a {message.performative} from {message.sender} is not a literal: {text(message.content)}",
    )


# --- questions ---------------------------------------------------------------------------------------------


def _ask_one(agent: Circumstance, message: SpeechAct) -> None:
    found = _first_belief(agent, message.content)
    if found is not None:
        answer(agent, message, found)
        return
    symbol, arguments, annotations = literal_from(message.content, message.sender)
    if symbol is None or agent.library.selects[trigger("+", "?", symbol)] is None:
        answer(agent, message, None)
        return
    agent.test_for(message, symbol, arguments, annotations)  # type: ignore[attr-defined]


def _first_belief(agent: Circumstance, query: Term) -> Term | None:
    trail = agent.trail
    for literal in _each_belief(agent, query):
        undo(trail, 0)
        return literal
    undo(trail, 0)
    return None


def _each_belief(agent: Circumstance, query: Term) -> Iterator[Term]:
    """Instances of a query that hold, with the annotations of the beliefs, the own source left out."""
    symbol, arguments, annotations = parts(query)
    if symbol is None:
        return
    tail = Var()
    question = Annotated((symbol, *arguments) if arguments else symbol, annotations, tail)
    for _ in run(solve_formula(agent, question, agent.trail), agent.options.rule_depth):
        found = resolve(question)
        rest = tuple(a for a in annotations_of(found) if a != SOURCE_SELF)
        inner = rename(bare(found))
        yield Annotated(inner, rest) if rest else inner


def _ask_all(agent: Circumstance, message: SpeechAct) -> None:
    found = list(_each_belief(agent, message.content))
    undo(agent.trail, 0)
    answer(agent, message, make_list(found))


def answer(
    agent: Circumstance, question: SpeechAct, content: Term | None, performative: str = "tell"
) -> None:
    """Send the answer to a question; None means that there is no answer."""
    agent.architecture.send(
        SpeechAct(
            "untell" if content is None else performative,
            agent.name if question.sender != "self" else "self",
            question.sender if question.sender != "self" else agent.name,
            question.content if content is None else rename(content),
            agent.next_message_id(),  # type: ignore[attr-defined]
            question.id,
        )
    )


# --- plans -------------------------------------------------------------------------------------------------


def _ask_how(agent: Circumstance, message: SpeechAct) -> None:
    """Answer with the plans, as ``tellHow``, so that a sender that does not wait for the answer adds them."""
    plans = relevant_plans(agent, message.content)
    if plans is None:
        _refuse(agent, message)
        answer(agent, message, None)
        return
    terms = make_list([lower_plan(plan.node, fresh_names()) for plan in plans])
    answer(agent, message, terms, "tellHow")


def _tell_how(agent: Circumstance, message: SpeechAct) -> None:
    if not agent.options.plans_from_others:
        agent.architecture.log("warning", f"refused a plan from {message.sender}: this run is restricted")
        return
    for content in _contents(message.content):
        try:
            agent.add_plan(content, atom(message.sender))  # type: ignore[attr-defined]
        except (AslError, ValueError) as fault:
            agent.architecture.log("warning", f"refused a plan from {message.sender}: {fault}")


def _untell_how(agent: Circumstance, message: SpeechAct) -> None:
    for content in _contents(message.content):
        agent.remove_plan(content, atom(message.sender))  # type: ignore[attr-defined]


def _undelivered(agent: Circumstance, message: SpeechAct) -> None:
    """Handle a message that was accepted, but did not reach an agent of another system."""
    _, content, reason = resolve(message.content)
    agent.architecture.log(
        "warning", f"message did not reach {message.sender} ({text(reason)}): {text(content)}"
    )


_ACTIONS = {
    "tell": _tell,
    "untell": _untell,
    "achieve": _achieve,
    "unachieve": _unachieve,
    "signal": _signal,
    "askOne": _ask_one,
    "askAll": _ask_all,
    "askHow": _ask_how,
    "tellHow": _tell_how,
    "untellHow": _untell_how,
    "ask-one": _ask_one,
    "ask-all": _ask_all,
    "ask-how": _ask_how,
    "tell-how": _tell_how,
    "untell-how": _untell_how,
    "undelivered": _undelivered,
}


# Questions of other agents that a plan for a test goal answers.


_ANSWER = trigger("+", "", functor("answer", 0, namespace="jacaros"))


def answer_by_plan(
    agent: Circumstance,
    message: SpeechAct,
    symbol: Functor,
    arguments: tuple[Term, ...],
    annotations: tuple[Term, ...],
) -> None:
    """Answer a question from another agent by a plan ``+?q``: begin an intention whose bottom frame sends the answer.

    Args:
        agent: who answers.
        message: the question.
        symbol, arguments, annotations: the test goal; the asker is a source of it.
    """
    intention = Intention(agent)
    goal = (trigger("+", "?", symbol), *arguments)
    intention.on_failed = (_answer_failure, (message, goal))
    answer_term = Annotated((symbol, *arguments) if arguments else symbol, annotations)
    frame: Frame = [send_answer, (_ANSWER,), BY_SELF, agent.trail.serial, ANSWER_PLAN, message, answer_term]
    intention.frames.append(frame)
    agent.post((goal, intention, annotations, None))


def send_answer(agent: Circumstance, frame: Frame) -> None:
    """The step of the bottom frame: send the answer of the plan."""
    message, found = frame[FIRST_SLOT:]
    answer(agent, message, without_sources(resolve(found)))
    frame[STEP] = None


def _answer_failure(
    agent: Circumstance, reason: FailureReason | None, message: SpeechAct, goal: tuple[Any, ...]
) -> None:
    """Send the answer if there is no plan (which is an answer) or the plan failed (which is logged)."""
    loss = None if reason is None else lost_question(message.sender, goal, reason)
    if loss is not None:
        agent.architecture.log("warning", loss.text())
    answer(agent, message, None)


ANSWER_PLAN = hidden_plan(atom("answer"))
"""The plan of the bottom frame."""
