"""Which agent is meant: the one that offers what you write."""

import re
from collections.abc import Callable, Sequence

from jacaros.runtime.errors import UsageError
from jacaros.runtime.files.texts import help_line, printable, suggestion
from jacaros.serving.client import Offered

GOALS, QUESTIONS, TELLS = ("goal",), ("question", "belief"), ("tell",)
"""What `achieve`, `ask` and `tell` are for."""
_NAME = re.compile(r"\s*('[^']*'|\w+)")
_MOST = 8

Written = Callable[[str, str, str], str]
"""Returns how to write a request, from the kind of its offer, its agent ("" for any) and its text."""


def noun(kind: str) -> str:
    """Return what an offer of a kind is, in words."""
    return "belief to tell" if kind == "tell" else kind


def name_in(text: str) -> str:
    """Return the functor of a literal; empty for another term."""
    found = _NAME.match(text)
    return found[1].strip("'") if found else ""


def chosen(
    offers: Sequence[Offered], kinds: tuple[str, ...], text: str, agent: str, written: Written
) -> Offered:
    """Return the offer that a text is about.

    Args:
        offers: all offers.
        kinds: kinds of offers that may be meant.
        text: a literal, such as ``deliver("p1", kitchen)``.
        agent: name of the agent; empty for the only one that offers it.
        written: how to write a request, for help.

    Raises:
        UsageError: nothing of the kind is offered under the name, or several agents offer it.
    """
    agents = dict.fromkeys(each.agent for each in offers)
    if agent and agent not in agents:
        help = suggestion(agent, agents, f"agents: {_listed(agents)}" if agents else "")
        raise _error(f"no agent `{agent}` offers anything to you", help)
    mine = [each for each in offers if agent in ("", each.agent)]
    name, wanted = name_in(text), noun(kinds[0])
    found = [each for each in mine if each.kind in kinds and each.name == name]
    if not found:
        raise _unknown(
            mine, kinds, name, f"{agent or 'no agent'} offers {'no' if agent else 'a'} {wanted}", written
        )
    owners = list(dict.fromkeys(each.agent for each in found))
    if len(owners) > 1:
        help = f"name the agent: {written(found[0].kind, owners[0], text)}"
        raise _error(f"{_listed(owners)} offer the {wanted} `{name}`", help)
    count = text.count(",") + 1 if "(" in text else 0
    return min(found, key=lambda each: abs(each.form.count(":") - count))


def _unknown(
    offers: Sequence[Offered], kinds: tuple[str, ...], name: str, told: str, written: Written
) -> UsageError:
    """Return the error for a name that is not offered: it may be of another kind, or misspelt."""
    other = next((each for each in offers if each.name == name and each.kind != "event"), None)
    if other is not None:
        help = written(other.kind, "", other.form)
        return _error(f"`{name}` is a {noun(other.kind)}, not a {noun(kinds[0])}", help)
    known = dict.fromkeys(each.name for each in offers if each.kind in kinds)
    return _error(f"{told} `{name}`", suggestion(name, known, f"offered: {_listed(known)}" if known else ""))


def _listed(names: Sequence[str] | dict[str, None]) -> str:
    every = list(names)
    return ", ".join(every[:_MOST]) + (", ..." if len(every) > _MOST else "")


def _error(what: str, help: str) -> UsageError:
    return UsageError("\n".join([f"error: {printable(what)}", *([help_line(help)] if help else [])]))
