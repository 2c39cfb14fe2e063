"""What agents offer, as tools and resources of MCP."""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Final
from urllib.parse import quote, unquote, urlsplit

import mcp_types as types

from jacaros.agents.language.offers import Offer, Parameter
from jacaros.look.why.why import FORMS
from jacaros.serving.arguments import called, results_schema, schema_of
from jacaros.serving.service import Session

LONGEST_NAME = 64
"""Maximum length of a tool's name that all clients take."""
_BUSY: Final = {
    "refuse": "a further one is refused",
    "wait": "a further one waits for its turn",
    "replace": "a further one replaces the oldest",
}
_FORMS = "; ".join(f"`{form}`: {answer}" for form, answer in FORMS.items())


@dataclass(frozen=True, slots=True)
class AgentOffer:
    """An offer of an agent.

    Attributes:
        agent: name of the agent.
        name: by which name callers call it.
        offer: the goal, the question, the belief, or the belief that callers may tell.
    """

    agent: str
    name: str
    offer: Offer


def offers_of(session: Session) -> list[AgentOffer]:
    """Return what agents offer to a caller."""
    offered = {agent: session.offers(agent) for agent in session.agents()}
    return [
        AgentOffer(agent, called(each, offers), each) for agent, offers in offered.items() for each in offers
    ]


def _asked(name: str, doc: str) -> tuple[Parameter, ...]:
    return (Parameter(name, "string", doc=doc),)


_OWN: Final = (
    Offer(
        "question", "goals", doc="List the goals that you gave, with their states and ids, the newest last."
    ),
    Offer(
        "tell",
        "cancel_goal",
        _asked("id", "id of the goal, from `goals`; `all` for all goals that you gave"),
        "Stop a goal: the agent drops it and cleans up, so a robot that moves for it stops.",
    ),
    Offer(
        "question",
        "why",
        _asked("question", "such as `why did the robot stop`"),
        f"Explain what happened in the run, and why. Questions: {_FORMS}.",
    ),
    Offer(
        "question",
        "why_not",
        _asked("what", "such as `go to the dock`, `!deliver(_, kitchen)` or `plan @label`"),
        "Explain why something did not happen.",
    ),
)
OWN: Final = {each.name: each for each in _OWN}
"""Tools that all runs have, by name."""


def named_tools(offered: Iterable[AgentOffer]) -> dict[str, AgentOffer]:
    """Return the offers of agents that are tools, by the names of the tools."""
    tools: dict[str, AgentOffer] = {}
    for each in offered:
        if each.offer.what not in ("goal", "question", "tell"):
            continue
        verb = "tell_" * (each.offer.what == "tell")
        wanted = re.sub(r"[^A-Za-z0-9_-]", "_", f"{each.agent}_{verb}{each.name}")[:LONGEST_NAME]
        name, number = wanted, 1
        while name in tools or name in OWN:
            number += 1
            name = f"{wanted[: LONGEST_NAME - 4]}_{number}"
        tools[name] = each
    return tools


def own_tools() -> list[types.Tool]:
    """Return the descriptions of the tools that all runs have."""
    return [_tool(each.name, each, each.doc) for each in _OWN]


def tool_of(name: str, tool: AgentOffer) -> types.Tool:
    """Return the description of a tool for clients."""
    offer = tool.offer
    schema: dict[str, Any] | None = results_schema(offer)
    if offer.what == "question":
        rows = {"type": "array", "items": schema}
        schema = {"type": "object", "properties": {"answers": rows}, "required": ["answers"]}
    elif len(offer.inputs) == len(offer.parameters):
        schema = None  # it has no results
    return _tool(name, offer, _description(tool), title=f"{tool.agent}: {offer.name}", output_schema=schema)


def _tool(name: str, offer: Offer, description: str, **more: Any) -> types.Tool:
    hints = types.ToolAnnotations(
        read_only_hint=offer.what == "question",
        destructive_hint="destructive" in offer.hints,
        idempotent_hint=offer.what != "goal" or "idempotent" in offer.hints,
    )
    schema = schema_of(offer.inputs)
    return types.Tool(name=name, description=description, input_schema=schema, annotations=hints, **more)


def _description(tool: AgentOffer) -> str:
    offer = tool.offer
    told = offer.doc or f"{offer.what} {offer}"
    if offer.what == "tell":
        return f"Tell the agent {tool.agent} a belief. {told}"
    if offer.what == "question":
        return f"Ask the agent {tool.agent}. {told}"
    many = "" if offer.at_most is None else f" At most {offer.at_most} at once; {_BUSY[offer.when_busy]}."
    return f"Give the agent {tool.agent} a goal. {told}{many}"


def belief_at(uri: str) -> tuple[str, str] | None:
    """Return agent and name of the belief at an address; None for another address."""
    try:
        parts = urlsplit(uri)
    except ValueError:
        return None
    folder, _, name = parts.path[1:].partition("/")
    if parts.scheme != "jacaros" or folder != "beliefs" or not name:
        return None
    return unquote(parts.netloc), unquote(name)


def resources_of(offered: Iterable[AgentOffer]) -> list[types.Resource]:
    """Return the offered beliefs as resources."""
    return [
        types.Resource(
            name=f"{each.agent}_{each.name}",
            title=f"{each.agent}: {each.offer}",
            uri=f"jacaros://{quote(each.agent, '')}/beliefs/{quote(each.name, '')}",
            description=each.offer.doc or f"Beliefs {each.offer} of the agent {each.agent}.",
            mime_type="application/json",
        )
        for each in offered
        if each.offer.what == "belief"
    ]
