"""Commands about agents: requests of the page's session, by the role that may send them."""

from collections.abc import Mapping, Sequence
from typing import Any, Literal

from jacaros.look.page.live.commands import Command, Text
from jacaros.look.records.records import FiniteNumber
from jacaros.look.why.tales import StoryLine
from jacaros.serving.arguments import called, schema_of
from jacaros.serving.service import Session

SHOWN = 20
"""Maximum number of goals of callers on a page."""
Performative = Literal[
    "tell", "untell", "achieve", "unachieve", "signal", "askOne", "askAll", "tellHow", "untellHow"
]


async def _why(session: Session, question: Text, at: FiniteNumber | None = None) -> str:
    return (await session.why(question, at)).text()


async def _story(session: Session) -> Sequence[StoryLine]:
    return await session.story()


def _offers(session: Session, agent: Text) -> list[dict[str, Any]]:
    offers = session.offers(agent, "goal") if agent in session.agents() else []
    return [
        {"name": called(each, offers), "doc": each.doc, "schema": schema_of(each.inputs)} for each in offers
    ]


def _goals(session: Session) -> list[dict[str, Any]]:
    return [each.data() for each in session.goals()[-SHOWN:]]


def _achieve(session: Session, agent: Text, goal: Text, arguments: dict[str, Any]) -> dict[str, Any]:
    return session.achieve(agent, goal, arguments).data()


def _cancel(session: Session, goal: Text) -> None:
    session.cancel(goal)


async def _answer(session: Session, question: Text, given: str | int) -> None:
    await session.answer(question, given)


def _message(session: Session, agent: Text, text: Text, performative: Performative) -> str:
    session.send(agent, performative, text)
    return "sent; answers appear in Messages" if performative.startswith("ask") else "sent"


def _console(session: Session, agent: Text, text: Text) -> str:
    return session.console(agent, text)


FOR_OBSERVERS: Mapping[str, Command] = {"why": _why, "story": _story, "offers": _offers, "goals": _goals}
FOR_USERS: Mapping[str, Command] = {"achieve": _achieve, "cancel": _cancel, "answer": _answer}
FOR_OPERATORS: Mapping[str, Command] = {"message": _message, "console": _console}
