"""Goals, answers, events and errors of a running system as lines of text."""

from collections.abc import Iterable, Mapping
from typing import Any

from jacaros.runtime.errors import JacarosError
from jacaros.runtime.files.texts import help_line
from jacaros.serving.client import ServiceError

Json = Mapping[str, Any]
_TOKEN_HELP = "give the system's token: --token TOKEN, or the environment variable JACAROS_TOKEN"


def value_text(value: Any) -> str:
    """Return a value as text, as in the language but without quotes."""
    match value:
        case bool():
            return str(value).lower()
        case list():
            return f"[{', '.join(map(value_text, value))}]"
        case {"functor": name, "arguments": list(arguments)}:
            return f"{name}({', '.join(map(value_text, arguments))})"
        case None:
            return "_"
    return str(value)


def row_text(row: Json) -> str:
    """Return values by name: ``X = 3, Y = kitchen``."""
    return ", ".join(f"{name} = {value_text(value)}" for name, value in row.items())


def answer_lines(answers: Iterable[Json]) -> list[str]:
    """Return a line for each answer; ``yes`` for one without variables, and ``no`` without answers."""
    return list(dict.fromkeys(row_text(each) or "yes" for each in answers)) or ["no"]


def state_text(goal: Json) -> str:
    """Return what is new about a goal: its state, and its results, reason or progress."""
    state = str(goal["state"])
    if state == "achieved":
        detail = row_text(goal["results"])
    elif state in ("refused", "failed"):
        detail = goal["message"]
    else:
        progress = goal["progress"]
        share = "" if progress is None else f"{progress:.0%}"
        detail = " ".join(each for each in (share, goal["note"]) if each)
    return f"{state}: {detail}" if detail else state


def event_text(event: Json, goal_name: str = "") -> str:
    """Return an event as a line.

    Args:
        event: the event.
        goal_name: name of the goal that it is about, such as ``goal 1``.
    """
    match event["event"]:
        case "goal":
            what = f"{goal_name} !{event['written']}".strip()
            told = f"{what} {state_text(event)}"
        case "announced":
            arguments = row_text(event["arguments"])
            told = f"announces {event['name']}" + (f": {arguments}" if arguments else "")
        case "belief":
            rows = [row_text(each) or "yes" for each in event["beliefs"]]
            told = f"believes {event['name']}: {'; '.join(rows) or 'no'}"
        case other:
            told = str(other).removeprefix("agent_")
    return f"[{event['agent']}] {told}"


def error_text(error: JacarosError) -> str:
    """Return an error of a request."""
    told = str(error)
    if isinstance(error, ServiceError) and error.code == "unauthorized":
        told += f"\n{help_line(_TOKEN_HELP)}"
    return told if told.startswith("error: ") else f"error: {told}"
