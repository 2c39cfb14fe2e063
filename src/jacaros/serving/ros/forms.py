"""Forms of goals and beliefs in ROS: messages of the package ``jacaros_interfaces``, or those that a mapping file names."""

import json
from collections.abc import Callable, Mapping
from typing import Any

from jacaros.agents.language.offers import Offer
from jacaros.robots.mapping.decoding import Unshowable
from jacaros.robots.mapping.encoding import WrongValue
from jacaros.robots.mapping.offer_codec import OfferCodec
from jacaros.serving.agent import Facts
from jacaros.serving.arguments import reasons_of
from jacaros.serving.callers import RequestError
from jacaros.serving.goals import RequestedGoal
from jacaros.serving.service import Session

UNKNOWN = -1.0
"""Progress of a goal whose agent says nothing about it."""
Fields = dict[str, Any]
"""Fields of a message."""


class AchieveForm:
    """Goals as ``jacaros_interfaces/action/Achieve``.

    Args:
        agent: name of the agent.
        name: the only goal of the action; empty for an action of all goals.
    """

    type_name = "jacaros_interfaces/action/Achieve"

    def __init__(self, agent: str, name: str = "") -> None:
        self._agent, self._name = agent, name

    def give(self, session: Session, request: Any) -> RequestedGoal:
        """Give the agent the goal: as text, or for an action of one goal its arguments as JSON."""
        written = request.goal.strip()
        if not self._name:
            return session.achieve(self._agent, written)
        if written and written[0] not in "{[":
            if written.partition("(")[0].strip() != self._name:
                text = f"expected the goal {self._name}, or its arguments as a JSON object or list"
                raise RequestError("invalid_arguments", text)
            return session.achieve(self._agent, written)
        try:
            arguments = json.loads(written) if written else ()
        except (ValueError, RecursionError) as error:
            raise RequestError("invalid_arguments", f"invalid JSON: {error}") from None
        return session.achieve(self._agent, self._name, arguments)

    def feedback(self, doing: str, progress: float | None, note: str) -> Fields:
        """Return the fields of feedback."""
        return {"doing": doing, "progress": UNKNOWN if progress is None else progress, "note": note}

    def result(self, goal: RequestedGoal) -> Fields:
        """Return everything about the end of the goal."""
        results, reasons = json.dumps(goal.results, ensure_ascii=False), reasons_of(goal.reasons)
        return {"state": goal.state, "results": results, "message": goal.message, "reasons": reasons}

    def refusal(self, error: RequestError) -> Fields:
        """Return why the request had no effect."""
        return {"state": error.code, "results": "{}", "message": error.message, "reasons": []}


class MappedForm:
    """Goals in the messages that a mapping file names.

    Args:
        agent: name of the agent.
        codec: reads and builds the messages.
        now: returns the time for stamps.
    """

    def __init__(self, agent: str, codec: OfferCodec, now: Callable[[], float]) -> None:
        self.type_name = codec.part.type_name.text
        self._agent, self._codec, self._now = agent, codec, now

    def give(self, session: Session, request: Any) -> RequestedGoal:
        """Give the agent the goal with the arguments that the fields of the message are."""
        try:
            arguments = self._codec.arguments(request)
        except Unshowable as error:
            raise RequestError("invalid_arguments", str(error)) from None
        return session.achieve(self._agent, self._codec.part.name, arguments)

    def feedback(self, doing: str, progress: float | None, note: str) -> Fields:
        """Return the fields of feedback."""
        known = {"doing": doing, "progress": UNKNOWN if progress is None else progress, "note": note}
        return self._codec.feedback(known, self._now())

    def result(self, goal: RequestedGoal) -> Fields | None:
        """Return the results; the defaults if the goal was not achieved."""
        if goal.state != "achieved":
            return None
        return self._codec.result(goal.results, self._now())

    def refusal(self, error: RequestError) -> None:
        """Return the defaults: the text of the outcome says why."""


GoalForm = AchieveForm | MappedForm
"""How goals, feedback and results are written in the messages of an action."""


def facts_as_json(facts: Facts) -> Fields:
    """Return beliefs as the fields of a ``std_msgs/msg/String``."""
    return {"data": json.dumps(facts, ensure_ascii=False)}


def newest_fact(codec: OfferCodec, now: Callable[[], float]) -> Callable[[Facts], Fields | None]:
    """Return a function that returns the fields of the message for beliefs: the newest one, or None."""

    def fields(facts: Facts) -> Fields | None:
        return codec.message(facts[-1], now()) if facts else None

    return fields


def wrong_names(offer: Offer, codec: OfferCodec) -> list[str]:
    """Return what a mapping says about an offer that its program does not declare."""
    outputs = {each.name for each in offer.parameters if each.output}
    inputs = {each.name for each in offer.inputs}
    known: Mapping[str, set[str]] = {"goal": inputs, "result": outputs, "fields": inputs}
    used = codec.part.used()
    wrong = [
        f"`{key}` names `{name}`, which {offer} does not have"
        for key, names in known.items()
        for name in sorted(used[key] - names)
    ]
    wrong += [
        f"`goal` lacks `{name}` of {offer}" for name in sorted(inputs - used["goal"]) if offer.what == "goal"
    ]
    return wrong


MISMATCH = (WrongValue, Unshowable)
"""Raised for values that the mapped type cannot hold."""
