"""Commands for agents: beliefs, goals, messages, and a console of AgentSpeak."""

from collections.abc import Callable, Mapping, Sequence
from itertools import islice

from jacaros.agents.body.values import UNKEPT, to_term
from jacaros.agents.language.loader import parse_term
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.mind.actions.internal_action import ActionError
from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules.context import Impure, ReadOnly, reading
from jacaros.agents.mind.state.act import SpeechAct
from jacaros.agents.mind.state.budget import SearchLimit
from jacaros.agents.mind.state.plan import Failure
from jacaros.agents.terms.substitution import resolve
from jacaros.agents.terms.text import excerpt, text
from jacaros.agents.terms.values import Term, Var
from jacaros.inspector.live.commands import LONGEST, Command, Given, Refused, choice_in, text_in
from jacaros.inspector.live.time_limit import within
from jacaros.mas.embedding.running_agent import OpenMind, question
from jacaros.mas.system import System

YOU = "you"
"""Sender of messages written on the page."""
ANSWERS = 20
"""Number of answers shown for a query."""
QUESTION_STEPS, QUESTION_TIME = 10_000, 0.1
"""Limits of a query: steps (see `jacaros.agents.mind.rules.context.reading`), and seconds."""
PERFORMATIVES = (
    "tell",
    "untell",
    "achieve",
    "unachieve",
    "signal",
    "askOne",
    "askAll",
    "tellHow",
    "untellHow",
)
_CONSOLE = "expected ?query, !goal, !!goal, +belief, -belief or -+belief"


def mind_commands(system: System) -> Mapping[str, Command]:
    """Return the commands for the agents of a system."""
    commands = _MindCommands(system)
    return {
        "belief": commands.belief,
        "goal": commands.goal,
        "message": commands.message,
        "console": commands.console,
    }


class _PageMind(OpenMind):
    def __init__(self, mind: Mind) -> None:
        self._mind = mind

    @property
    def mind(self) -> Mind:
        """The agent."""
        return self._mind


class _You:
    """Receives replies to messages of the page, and other messages to `YOU`; they are recorded like all messages.

    Agents do not find it among the names of the system, so broadcasts do not reach it.
    """

    def names(self) -> Sequence[str]:
        """No name: no other agent must know of the page."""
        return ()

    def find(self, name: str) -> "_You | None":
        """Find the mailbox."""
        return self if name == YOU else None

    def receive(self, message: SpeechAct) -> None:
        """Ignore the message: the record of its delivery shows it."""


class _MindCommands:
    def __init__(self, system: System) -> None:
        self._system = system
        self._messages = 0
        system.directory.join(_You())

    def _mind(self, given: Given) -> _PageMind:
        name = text_in(given, "agent")
        host = self._system.directory.find(name)
        if host is None or host.ended:
            raise Refused(f"unknown agent: `{name[:80]}`")
        if not isinstance(host.mind, Mind):
            raise Refused(f"`{name}` is written in Python: it has no beliefs and goals of the language")
        return _PageMind(host.mind)

    def belief(self, given: Given) -> None:
        """Add or remove a belief."""
        mind, written = self._mind(given), text_in(given, "text")
        if choice_in(given, "op", ("+", "-")) == "+":
            mind.add_belief(written)
        else:
            _remove(mind, written)

    def goal(self, given: Given) -> None:
        """Post or drop a goal."""
        mind, written = self._mind(given), text_in(given, "text").lstrip("!")
        if choice_in(given, "op", ("post", "drop")) == "post":
            mind.post_goal(written)
        elif not mind.drop_goal(written):
            raise Refused(f"the agent does not pursue {written}")

    def message(self, given: Given) -> str:
        """Send a message to an agent; return the text to print."""
        receiver, content = text_in(given, "agent"), text_in(given, "text")
        performative = choice_in(given, "performative", PERFORMATIVES)
        how = performative in ("tellHow", "untellHow")
        term = to_term(content, UNKEPT) if how else lower_value(parse_term(content))
        self._messages += 1
        try:
            known = self._system.deliver(SpeechAct(performative, YOU, receiver, term, self._messages))
        except Failure as failure:
            raise Refused(str(failure)) from None
        if not known:
            raise Refused(f"unknown agent: `{receiver[:80]}`")
        return "sent; answers appear in Messages" if performative.startswith("ask") else "sent"

    def console(self, given: Given) -> str:
        """Execute a line of AgentSpeak; return the text to print."""
        mind, line = self._mind(given), text_in(given, "text").removesuffix(".")
        for prefix, execute in _LINES.items():
            if line.startswith(prefix):
                written = line.removeprefix(prefix).strip()
                if not written:
                    break
                return execute(mind, written)
        raise Refused(_CONSOLE)


def _ask(mind: OpenMind, formula: str) -> str:
    """Return the answers of a formula, one per line: ``X = 3, Y = kitchen``; ``yes`` or ``no`` without variables.

    A question changes nothing, whatever it calls; see `jacaros.agents.mind.rules.context`.
    """
    agent = mind.mind
    if agent.running:
        raise Refused("the agent is in the middle of a step: ask again")
    with reading(agent, QUESTION_STEPS) as view:
        answers = within(QUESTION_TIME, lambda: _answers(view, formula))
    if answers is None:
        raise Refused(f"the question takes longer than {QUESTION_TIME} s; ask a simpler one")
    return answers


def _answers(view: ReadOnly, formula: str) -> str:
    term, names = question(formula)
    shown = {name: value for name, value in names.items() if name[0] != "_"}
    try:
        lines = [_values(shown) or "yes" for _ in islice(view.answers(term), ANSWERS + 1)]
    except (Impure, SearchLimit, ActionError, Failure, RecursionError) as error:
        raise Refused(str(error)) from None
    if not shown:
        lines = lines[:1]
    return "\n".join([*lines[:ANSWERS], *(["..."] if len(lines) > ANSWERS else [])]) or "no"


def _values(shown: Mapping[str, Term]) -> str:
    """Return the bound variables: ``X = 3, Y = kitchen``."""
    found = ((name, resolve(excerpt(value, LONGEST))) for name, value in shown.items())
    return ", ".join(f"{name} = {text(value)}" for name, value in found if value.__class__ is not Var)


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
