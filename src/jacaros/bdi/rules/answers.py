"""Questions of other agents that a plan for a test goal answers."""

from jacaros.asl import nodes
from jacaros.bdi.explaining.failure_reason import FailureReason
from jacaros.bdi.explaining.lost_goals import lost_question
from jacaros.bdi.rules.proc_msg import answer
from jacaros.bdi.state.belief_base import without_sources
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.intention import Frame
from jacaros.bdi.state.plan import Plan
from jacaros.bdi.state.speech_act import SpeechAct
from jacaros.bdi.state.triggers import trigger
from jacaros.terms.substitution import resolve
from jacaros.terms.values import BY_SELF, Annotated, Functor, Term, atom, functor

_ANSWER = trigger("+", "", functor("answer", 0, namespace="jacaros"))


class AnswerByPlan:
    """A question from another agent that a plan ``+?q`` of this one answers.

    Args:
        agent: who answers.
        message: the question.
        symbol, arguments, annotations: the test goal; the asker is a source of it.
    """

    def __init__(
        self,
        agent: Circumstance,
        message: SpeechAct,
        symbol: Functor,
        arguments: tuple[Term, ...],
        annotations: tuple[Term, ...],
    ) -> None:
        self.agent, self.message, self.annotations = agent, message, annotations
        self.goal = (trigger("+", "?", symbol), *arguments)

    def begin(self) -> None:
        """Begin an intention whose bottom frame sends the answer."""
        agent = self.agent
        intention = agent.new_intention()
        intention.on_failed = self.failed
        frame: Frame = [self._answered, (_ANSWER,), BY_SELF, agent.trail.serial, _answer_plan()]
        intention.frames.append(frame)
        agent.post((self.goal, intention, self.annotations, None))

    def _answered(self, agent: Circumstance, frame: Frame) -> None:
        symbol = self.goal[0].functor
        term: Term = (symbol, *self.goal[1:]) if len(self.goal) > 1 else symbol
        answer(agent, self.message, without_sources(resolve(Annotated(term, self.annotations))))
        frame[0] = None

    def failed(self, reason: FailureReason | None) -> None:
        """No plan, which is an answer, or a plan that failed, which is logged."""
        loss = None if reason is None else lost_question(self.message.sender, self.goal, reason)
        if loss is not None:
            self.agent.architecture.log("warning", loss.text())
        answer(self.agent, self.message, None)


def _answer_plan() -> Plan:
    node = nodes.Plan(None, nodes.Trigger("+", "!", nodes.Literal("answer")), None, nodes.Body())
    return Plan(node, atom("answer"))
