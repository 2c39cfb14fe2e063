"""The OpenAPI document of what agents offer to a caller, made from their declarations."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final
from urllib.parse import quote

from jacaros.agents.language.offers import Offer, Parameter
from jacaros.serving.arguments import called, schema_of
from jacaros.serving.arguments import described as data_of_offer
from jacaros.version import VERSION

Json = dict[str, Any]
KINDS: Final = {
    "goal": "goals",
    "belief": "beliefs",
    "question": "questions",
    "tell": "tells",
    "event": "events",
}
"""Plural of each kind of offer, as in the description of an agent."""
_TEXT: Final[Json] = {"type": "string"}
_NUMBER: Final[Json] = {"type": ["number", "null"]}
_GOAL: Final[Json] = {
    "type": "object",
    "properties": {
        **dict.fromkeys(("id", "agent", "goal", "written", "caller", "note", "doing", "message"), _TEXT),
        "state": {
            "enum": [
                "pending",
                "waiting",
                "running",
                "cancelling",
                "achieved",
                "failed",
                "refused",
                "cancelled",
            ]
        },
        "progress": _NUMBER,
        "began": {"type": "number"},
        "ended": _NUMBER,
        "arguments": {"type": "object"},
        "results": {"type": "object"},
        "reasons": {"type": "array", "items": _TEXT},
    },
}
_PROBLEM: Final[Json] = {
    "type": "object",
    "properties": {
        **dict.fromkeys(("type", "title", "detail", "code", "goal"), _TEXT),
        "status": {"type": "integer"},
        "reasons": {"type": "array", "items": _TEXT},
    },
    "required": ["type", "title", "status", "detail", "code", "reasons"],
}


def described(agent: str, offers: Iterable[Offer]) -> Json:
    """Return what an agent offers."""
    found: Json = {"name": agent, **{plural: [] for plural in KINDS.values()}}
    for offer in offers:
        found[KINDS[offer.what]].append(data_of_offer(offer))
    return found


def _results(offer: Offer) -> Sequence[Parameter]:
    return [each for each in offer.parameters if each.output]


def document(title: str, offered: Mapping[str, Sequence[Offer]]) -> Json:
    """Return the document.

    Args:
        title: name of the run.
        offered: what each agent offers to the caller.
    """
    paths: dict[str, Json] = {}

    def add(method: str, path: str, operation: Json) -> None:
        paths.setdefault(path, {})[method] = operation

    goal, wait = (
        _parameter("id", "path"),
        _parameter("Prefer", "header", "`wait=N`: wait up to N seconds for the end"),
    )
    add("get", "/agents", _operation("List the agents", {"200": _json("Agents")}))
    add("get", "/goals", _operation("List goals, the newest last", {"200": _json("Goals")}))
    add("get", "/goals/{id}", _operation("Show a goal", {"200": _json("The goal", _ref("Goal"))}, goal, wait))
    ended = {"200": _json("It has ended", _ref("Goal")), "202": _json("It is being cancelled", _ref("Goal"))}
    add("delete", "/goals/{id}", _operation("Cancel a goal", ended, goal, wait))
    stream = {"200": {"description": "Events", "content": {"text/event-stream": {"schema": _TEXT}}}}
    watched = _parameter("beliefs", "query", "beliefs to watch: `AGENT.BELIEF`, separated by commas")
    add("get", "/events", _operation("Hear of goals, beliefs and announced events", stream, watched))
    question, at = _parameter("question", "query"), _parameter("at", "query", "seconds since the run began")
    add("get", "/why", _operation("Explain the run", {"200": _json("Explanation")}, question, at))
    add("get", "/artifacts", _operation("List artifacts (operators)", {"200": _json("Artifacts")}))
    add("get", "/questions", _operation("List open questions to a person", {"200": _json("Questions")}))
    given = {"type": "object", "properties": {"text": _TEXT, "option": {"type": "integer"}}}
    answer = _operation("Answer a question to a person", {"204": {"description": "Answered"}}, goal)
    add("post", "/questions/{id}", answer | _body(given))
    for agent, offers in offered.items():
        for method, path, operation in _written():
            add(method, f"/agents/{quote(agent, '')}/{path}", operation | {"tags": [agent]})
        for offer in offers:
            for method, path, operation in _operations(offer, called(offer, offers)):
                add(method, f"/agents/{quote(agent, '')}/{path}", operation | {"tags": [agent]})
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


def _written() -> Iterable[tuple[str, str, Json]]:
    """Yield methods, paths and operations that take text in the language."""
    written = {"type": "object", "properties": {"text": _TEXT}, "required": ["text"]}
    body, done = _body(written), {"204": {"description": "Done"}}
    wait = _parameter("Prefer", "header", "`wait=N`: wait up to N seconds for the end")
    yield (
        "post",
        "goals",
        _operation("Give a goal, as text", {"201": _json("Given", _ref("Goal"))}, wait) | body,
    )
    yield "post", "questions", _operation("Ask a question, as text", {"200": _json("Answers")}) | body
    yield "post", "beliefs", _operation("Tell a belief, as text", done) | body
    yield "delete", "beliefs", _operation("Take back a belief, as text", done) | body


def _operations(offer: Offer, name: str) -> Iterable[tuple[str, str, Json]]:
    """Yield methods, paths and operations of an offer with a name for callers."""
    name, doc = quote(name), offer.doc or str(offer)
    if offer.what == "goal":
        results = _ref("Goal") | {"properties": {"results": schema_of(_results(offer)) | {"required": []}}}
        refused = {
            "description": "Refused",
            "content": {"application/problem+json": {"schema": _ref("Problem")}},
        }
        wait = _parameter("Prefer", "header", "`wait=N`: wait up to N seconds for the end")
        found = _operation(doc, {"201": _json("Given", results), "409": refused}, wait)
        yield "post", f"goals/{name}", found | _body(schema_of(offer.inputs))
    elif offer.what == "belief":
        rows = _rows("beliefs", schema_of(offer.parameters))
        yield "get", f"beliefs/{name}", _operation(doc, {"200": _json("Beliefs", rows)})
    elif offer.what == "question":
        rows = _rows("answers", schema_of(_results(offer)))
        found = _operation(doc, {"200": _json("Answers", rows)})
        yield "post", f"questions/{name}", found | _body(schema_of(offer.inputs))
    elif offer.what == "tell":
        body, done = _body(schema_of(offer.parameters)), {"204": {"description": "Done"}}
        yield "post", f"beliefs/{name}", _operation(doc, done) | body
        yield "delete", f"beliefs/{name}", _operation(f"Take back: {doc}", done) | body


def _operation(summary: str, responses: Json, *parameters: Json) -> Json:
    failed = {"description": "Problem", "content": {"application/problem+json": {"schema": _ref("Problem")}}}
    found: Json = {"summary": summary, "responses": {**responses, "default": failed}}
    return found | ({"parameters": list(parameters)} if parameters else {})


def _parameter(name: str, place: str, doc: str = "") -> Json:
    found: Json = {"name": name, "in": place, "required": place == "path", "schema": _TEXT}
    return found | ({"description": doc} if doc else {})


def _body(schema: Json) -> Json:
    needed = bool(schema.get("required"))
    return {"requestBody": {"required": needed, "content": {"application/json": {"schema": schema}}}}


def _json(description: str, schema: Json | None = None) -> Json:
    return {
        "description": description,
        "content": {"application/json": {"schema": schema or {"type": "object"}}},
    }


def _rows(name: str, schema: Json) -> Json:
    return {"type": "object", "properties": {name: {"type": "array", "items": schema}}}


def _ref(name: str) -> Json:
    return {"$ref": f"#/components/schemas/{name}"}
