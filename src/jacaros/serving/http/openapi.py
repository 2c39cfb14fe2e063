"""The OpenAPI document of what agents offer to a caller, made from their declarations."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final
from urllib.parse import quote

from jacaros.agents.language.offers import WHAT, Offer
from jacaros.serving import arguments
from jacaros.version import VERSION

Json = dict[str, Any]


def described(agent: str, offers: Iterable[Offer]) -> Json:
    """Return what an agent offers."""
    found: Json = {"name": agent, **{f"{what}s": [] for what in WHAT}}
    for offer in offers:
        found[f"{offer.what}s"].append(arguments.described(offer))
    return found


def document(title: str, offered: Mapping[str, Sequence[Offer]]) -> Json:
    """Return the document.

    Args:
        title: name of the run.
        offered: what each agent offers to the caller.
    """
    paths: dict[str, Json] = {path: dict(operations) for path, operations in _GENERAL.items()}
    for agent, offers in offered.items():
        own = [_operations(each, offers) for each in offers if each.what != "event"]
        for path, operations in [*_WRITTEN.items(), *own]:
            known = paths.setdefault(f"/agents/{quote(agent, '')}/{path}", {})
            known.update({method: each | {"tags": [agent]} for method, each in operations.items()})
    return {
        "openapi": "3.1.0",
        "info": {"title": title, "version": VERSION},
        "security": [{"token": []}],
        "paths": paths,
        "components": {
            "securitySchemes": {"token": {"type": "http", "scheme": "bearer"}},
            "schemas": {"Goal": _GOAL, "Problem": _PROBLEM},
        },
    }


def _operations(offer: Offer, offers: Sequence[Offer]) -> tuple[str, Json]:
    """Return the path of one of the offers of an agent, and its operations by method."""
    name, doc = quote(arguments.called(offer, offers)), offer.doc or str(offer)
    schemas = arguments.described(offer)
    given, results = schemas["arguments"], schemas.get("results")
    match offer.what:
        case "goal":
            goal = _ref("Goal") | {"properties": {"results": results}}
            return f"goals/{name}", {"post": _operation(doc, _given(goal), _WAIT, body=given)}
        case "belief":
            return f"beliefs/{name}", {"get": _operation(doc, _ok("Beliefs", _rows("beliefs", given)))}
        case "question":
            answers = _ok("Answers", _rows("answers", results))
            return f"questions/{name}", {"post": _operation(doc, answers, body=given)}
    back = _operation(f"Take back: {doc}", _DONE, body=given)
    return f"beliefs/{name}", {"post": _operation(doc, _DONE, body=given), "delete": back}


def _operation(summary: str, responses: Json, *parameters: Json, body: Json | None = None) -> Json:
    found: Json = {"summary": summary, "responses": responses | {"default": _problem("Problem")}}
    if parameters:
        found["parameters"] = list(parameters)
    if body is not None:
        required = bool(body.get("required"))
        found["requestBody"] = {"required": required, "content": {"application/json": {"schema": body}}}
    return found


def _ok(description: str, schema: Json | None = None) -> Json:
    return {"200": _content(description, schema or {"type": "object"})}


def _given(goal: Json) -> Json:
    return {"201": _content("Given", goal), "409": _problem("Refused")}


def _problem(description: str) -> Json:
    return _content(description, _ref("Problem"), "application/problem+json")


def _content(description: str, schema: Json, kind: str = "application/json") -> Json:
    return {"description": description, "content": {kind: {"schema": schema}}}


def _parameter(name: str, place: str, doc: str = "") -> Json:
    return {"name": name, "in": place, "required": place == "path", "schema": _TEXT, "description": doc}


def _rows(name: str, schema: Json | None) -> Json:
    return {"type": "object", "properties": {name: {"type": "array", "items": schema}}}


def _ref(name: str) -> Json:
    return {"$ref": f"#/components/schemas/{name}"}


_TEXT: Final[Json] = {"type": "string"}
_TEXTS: Final[Json] = {"type": "array", "items": _TEXT}
_NUMBER: Final[Json] = {"type": ["number", "null"]}
_STATES: Final = "pending waiting running cancelling achieved failed refused cancelled"
_GOAL: Final[Json] = {
    "type": "object",
    "properties": {
        **dict.fromkeys(("id", "agent", "goal", "written", "caller", "note", "doing", "message"), _TEXT),
        "state": {"enum": _STATES.split()},
        "progress": _NUMBER,
        "began": {"type": "number"},
        "ended": _NUMBER,
        "arguments": {"type": "object"},
        "results": {"type": "object"},
        "reasons": _TEXTS,
    },
}
_PROBLEM: Final[Json] = {
    "type": "object",
    "properties": {
        **dict.fromkeys(("type", "title", "detail", "code", "goal"), _TEXT),
        "status": {"type": "integer"},
        "reasons": _TEXTS,
    },
    "required": ["type", "title", "status", "detail", "code", "reasons"],
}
_DONE: Final[Json] = {"204": {"description": "Done"}}
_ID: Final = _parameter("id", "path")
_WAIT: Final = _parameter("Prefer", "header", "`wait=N`: wait up to N seconds for the end")
_ENDED: Final = _ok("The goal", _ref("Goal"))
_CANCELLING: Final = {"202": _content("It is being cancelled", _ref("Goal"))}
_EVENTS: Final[Json] = {"200": _content("Events", _TEXT, "text/event-stream")}
_WATCHED: Final = _parameter("beliefs", "query", "beliefs to watch: `AGENT.BELIEF`, separated by commas")
_WHY: Final = (
    _parameter("question", "query"),
    _parameter("at", "query", "seconds since the run began"),
)
_ANSWER: Final[Json] = {"type": "object", "properties": {"text": _TEXT, "option": {"type": "integer"}}}
_BY_TEXT: Final[Json] = {"type": "object", "properties": {"text": _TEXT}, "required": ["text"]}
_GENERAL: Final[dict[str, Json]] = {
    "/agents": {"get": _operation("List the agents", _ok("Agents"))},
    "/goals": {"get": _operation("List goals, the newest last", _ok("Goals"))},
    "/goals/{id}": {
        "get": _operation("Show a goal", _ENDED, _ID, _WAIT),
        "delete": _operation("Cancel a goal", _ENDED | _CANCELLING, _ID, _WAIT),
    },
    "/events": {"get": _operation("Hear of goals, beliefs and announced events", _EVENTS, _WATCHED)},
    "/why": {"get": _operation("Explain the run", _ok("Explanation"), *_WHY)},
    "/artifacts": {"get": _operation("List artifacts (operators)", _ok("Artifacts"))},
    "/questions": {"get": _operation("List open questions to a person", _ok("Questions"))},
    "/questions/{id}": {"post": _operation("Answer a question to a person", _DONE, _ID, body=_ANSWER)},
}
"""Operations by path and method."""
_WRITTEN: Final[dict[str, Json]] = {
    "goals": {"post": _operation("Give a goal, as text", _given(_ref("Goal")), _WAIT, body=_BY_TEXT)},
    "questions": {"post": _operation("Ask a question, as text", _ok("Answers"), body=_BY_TEXT)},
    "beliefs": {
        "post": _operation("Tell a belief, as text", _DONE, body=_BY_TEXT),
        "delete": _operation("Take back a belief, as text", _DONE, body=_BY_TEXT),
    },
}
"""Operations of each agent that take text in the language."""
