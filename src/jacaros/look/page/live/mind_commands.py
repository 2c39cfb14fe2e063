"""Commands for agents: beliefs, goals, messages, and a console of AgentSpeak."""

from collections.abc import Callable, Mapping, Sequence
from itertools import count
from typing import Literal

from jacaros.agents.body.values import UNKEPT, to_term
from jacaros.agents.language.loader import parse_term
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.state.act import SpeechAct
from jacaros.agents.mind.state.plan import Failure
from jacaros.look.page.live.commands import YOU, Command, Refused, Text
from jacaros.runtime.mas.embedding.running_agent import OpenMind
from jacaros.runtime.mas.system import System
from jacaros.serving.callers import RequestError
from jacaros.serving.questions import ask

Performative = Literal[
    "tell", "untell", "achieve", "unachieve", "signal", "askOne", "askAll", "tellHow", "untellHow"
]
_CONSOLE = "expected ?query, !goal, !!goal, +belief, -belief or -+belief"


class _PageMind(OpenMind):
    def __init__(self, mind: Mind) -> None:
        self._mind = mind

    @property
    def mind(self) -> Mind:
        return self._mind


class _You:
    """Receives replies to messages of the page, and other messages to `YOU`; they are recorded like all messages.

    Agents do not find it among the names of the system, so broadcasts do not reach it.
    """

    def names(self) -> Sequence[str]:
        """No name: no other agent must know of the page."""
        return ()

    def find(self, name: str) -> "_You | None":
        return self if name == YOU else None

    def receive(self, message: SpeechAct) -> None:
        """Ignore the message: the record of its delivery shows it."""


def mind_commands(system: System) -> Mapping[str, Command]:
    """Return the commands for the agents of a system."""
    numbers = count(1)
    system.directory.join(_You())

    def mind_of(agent: str) -> _PageMind:
        host = system.directory.find(agent)
        if host is None or host.ended:
            raise Refused(f"unknown agent: `{agent[:80]}`")
        if not isinstance(host.mind, Mind):
            raise Refused(f"`{agent}` is written in Python: it has no beliefs and goals of the language")
        return _PageMind(host.mind)

    def belief(agent: Text, text: Text, op: Literal["+", "-"]) -> None:
        (_add if op == "+" else _remove)(mind_of(agent), text)

    def goal(agent: Text, text: Text, op: Literal["post", "drop"]) -> None:
        mind, written = mind_of(agent), text.lstrip("!")
        if op == "post":
            mind.post_goal(written)
        elif not mind.drop_goal(written):
            raise Refused(f"the agent does not pursue {written}")

    def message(agent: Text, text: Text, performative: Performative) -> str:
        how = performative in ("tellHow", "untellHow")
        term = to_term(text, UNKEPT) if how else lower_value(parse_term(text))
        try:
            known = system.deliver(SpeechAct(performative, YOU, agent, term, next(numbers)))
        except Failure as failure:
            raise Refused(str(failure)) from None
        if not known:
            raise Refused(f"unknown agent: `{agent[:80]}`")
        return "sent; answers appear in Messages" if performative.startswith("ask") else "sent"

    def console(agent: Text, text: Text) -> str:
        mind, line = mind_of(agent), text.removesuffix(".")
        prefix = next((each for each in _LINES if line.startswith(each)), "")
        written = line.removeprefix(prefix).strip()
        if not prefix or not written:
            raise Refused(_CONSOLE)
        return _LINES[prefix](mind, written)

    return {"belief": belief, "goal": goal, "message": message, "console": console}


def _ask(mind: OpenMind, formula: str) -> str:
    """Return the answers of a formula, one per line: ``X = 3, Y = kitchen``; ``yes`` or ``no`` without variables."""
    try:
        return ask(mind.mind, formula)
    except RequestError as error:
        raise Refused(error.message) from None


def _post(mind: OpenMind, written: str) -> str:
    mind.post_goal(written)
    return f"posted !{written}"


def _add(mind: OpenMind, written: str) -> str:
    mind.add_belief(written)
    return f"added {written}"


def _remove(mind: OpenMind, written: str) -> str:
    if not mind.believes(written):
        raise Refused(f"the agent does not believe {written}")
    mind.remove_belief(written)
    return f"removed {written}"


def _replace(mind: OpenMind, written: str) -> str:
    mind.replace_belief(written)
    return f"replaced {written}"


_LINES: dict[str, Callable[[OpenMind, str], str]] = {
    "?": _ask,
    "!!": _post,
    "!": _post,
    "-+": _replace,
    "+": _add,
    "-": _remove,
}
"""First characters of a line, longer ones first, and what it does."""
