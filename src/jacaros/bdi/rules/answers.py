"""Questions of other agents that a plan for a test goal answers."""

from typing import Any

from jacaros.bdi.explaining.failure_reason import FailureReason
from jacaros.bdi.explaining.lost_goals import lost_question
from jacaros.bdi.rules.proc_msg import answer
from jacaros.bdi.state.belief_base import without_sources
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.intention import FIRST_SLOT, STEP, Frame
from jacaros.bdi.state.plan import hidden_plan
from jacaros.bdi.state.speech_act import SpeechAct
from jacaros.bdi.state.triggers import trigger
from jacaros.terms.substitution import resolve
from jacaros.terms.values import BY_SELF, Annotated, Functor, Term, atom, functor

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
    intention = agent.new_intention()
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
