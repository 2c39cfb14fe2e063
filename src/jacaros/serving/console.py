"""What an operator may do to any agent, whatever it offers: beliefs, goals, questions and messages."""

from collections.abc import Callable, Sequence
from itertools import count

from jacaros.agents.body.values import UNKEPT, to_term
from jacaros.agents.language.diagnostics import AslError
from jacaros.agents.language.loader import parse_term
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules import belief_update, goals
from jacaros.agents.mind.state.act import SpeechAct
from jacaros.agents.mind.state.belief_base import parts
from jacaros.agents.mind.state.plan import Failure
from jacaros.agents.terms.values import BY_SELF, Term
from jacaros.runtime.mas.embedding.running_agent import literal
from jacaros.runtime.mas.system import System
from jacaros.runtime.trace import Cause
from jacaros.serving.callers import RequestError, check_text
from jacaros.serving.questions import ask, first_line

YOU = "you"
"""Sender of an operator's messages."""
_EXPECTED = "expected ?query, !goal, -!goal, +belief, -belief or -+belief"
_PROGRAMS = ("tellHow", "untellHow")


class Operator:
    """Executes an operator's requests. It receives the replies to the messages, which the run records.

    Agents do not find it among the names of the system, so broadcasts do not reach it.

    Args:
        system: the run.
    """

    def __init__(self, system: System) -> None:
        self._system = system
        self._numbers = count(1)
        system.directory.join(self)

    def names(self) -> Sequence[str]:
        """No name: no other agent must know of it."""
        return ()

    def find(self, name: str) -> "Operator | None":
        return self if name == YOU else None

    def receive(self, message: SpeechAct) -> None:
        """Ignore the message: the record of its delivery shows it."""

    def execute(self, agent: str, line: str, cause: Cause | None) -> str:
        """Execute a line of AgentSpeak, and return what it led to, as text; see `Session.console`."""
        mind, line = self._mind(agent), check_text(line.strip()).removesuffix(".")
        prefix = next((each for each in ("?", *_LINES) if line.startswith(each)), "")
        written = line.removeprefix(prefix).strip()
        if not prefix or not written:
            raise RequestError("invalid_arguments", _EXPECTED)
        if prefix == "?":
            return ask(mind, written)
        act, done = _LINES[prefix]
        act(mind, _parsed(literal, written), cause)
        return f"{done}{written}"

    def send(self, agent: str, performative: str, content: str, cause: Cause | None) -> None:
        """Send a message to an agent; see `Session.send`."""
        how = performative in _PROGRAMS
        if how and self._system.options.restricted:
            raise RequestError("not_permitted", "this run is restricted (--restrict): it takes no plans")
        check_text(content)
        term = to_term(content, UNKEPT) if how else _parsed(_term, content)
        message = SpeechAct(performative, YOU, agent, term, next(self._numbers))
        try:
            known = self._system.mailboxes.deliver(message, cause)
        except Failure as failure:
            raise RequestError("unanswerable", str(failure)) from None
        if not known:
            raise RequestError("unknown_agent", f"unknown agent: `{agent[:80]}`")

    def _mind(self, agent: str) -> Mind:
        host = self._system.directory.find(agent)
        if host is None or host.ended:
            raise RequestError("unknown_agent", f"unknown agent: `{agent[:80]}`")
        if not isinstance(host.mind, Mind):
            told = f"`{agent}` is written in Python: it has no beliefs and goals of the language"
            raise RequestError("unknown_agent", told)
        return host.mind


def soon(mind: Mind, change: Callable[[], object]) -> None:
    """Change a mind now, or before its next step if it is in the middle of one."""

    def make(_: object = None) -> None:
        change()

    if mind.running:
        mind.do_soon(make)
    else:
        make()
    mind.architecture.ready()


def _parsed(parse: Callable[[str], Term], written: str) -> Term:
    try:
        return parse(written)
    except AslError as error:
        raise RequestError("invalid_arguments", first_line(error)) from None


def _term(written: str) -> Term:
    return lower_value(parse_term(written))


def _post(mind: Mind, goal: Term, cause: Cause | None) -> None:
    soon(mind, lambda: mind.post_goal(goal, cause))


def _drop(mind: Mind, goal: Term, cause: Cause | None) -> None:
    if not (goals.intentions_for(mind, goal) or goals.goal_events(mind, goal)):
        raise RequestError("unknown_goal", "the agent does not pursue this goal")
    soon(mind, lambda: goals.drop_desire(mind, goal))


def _add(mind: Mind, belief: Term, cause: Cause | None) -> None:
    soon(mind, lambda: belief_update.tell(mind, belief, cause))


def _remove(mind: Mind, belief: Term, cause: Cause | None) -> None:
    removed: list[bool] = []
    soon(mind, lambda: removed.append(belief_update.untell(mind, belief, cause)))
    if removed == [False]:
        raise RequestError("invalid_arguments", "the agent does not believe this")


def _replace(mind: Mind, belief: Term, cause: Cause | None) -> None:
    symbol, _, annotations = parts(belief)
    if symbol is not None:
        soon(mind, lambda: belief_update.delete_any(mind, symbol, annotations or BY_SELF))
    _add(mind, belief, cause)


_LINES: dict[str, tuple[Callable[[Mind, Term, Cause | None], None], str]] = {
    "!!": (_post, "posted !"),
    "!": (_post, "posted !"),
    "-!": (_drop, "dropped !"),
    "-+": (_replace, "replaced "),
    "+": (_add, "added "),
    "-": (_remove, "removed "),
}
"""First characters of a line, longer ones first: what it does, and how the answer begins."""
