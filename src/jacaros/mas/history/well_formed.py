"""Validation of records: a recording may be damaged, or written by another program."""

from collections.abc import Callable, Mapping

Check = Callable[[object], bool]


def _text(value: object) -> bool:
    return isinstance(value, str)


def _whole(value: object) -> bool:
    return isinstance(value, int)


def _id(value: object) -> bool:
    return value is None or isinstance(value, (int, str))


def _maybe_text(value: object) -> bool:
    return value is None or isinstance(value, str)


def _maybe_number(value: object) -> bool:
    return value is None or isinstance(value, (int, float))


def _maybe_whole(value: object) -> bool:
    return value is None or isinstance(value, int)


def _list(each: Check) -> Check:
    """Check a list whose items pass a check. None stands for an empty one."""
    return lambda value: value is None or (isinstance(value, (list, tuple)) and all(map(each, value)))


def _fields(required: Mapping[str, Check], optional: Mapping[str, Check]) -> Check:
    def check(value: object) -> bool:
        return (
            isinstance(value, Mapping)
            and all(name in value and is_right(value[name]) for name, is_right in required.items())
            and all(is_right(value.get(name)) for name, is_right in optional.items())
        )

    return check


_PLACE: Mapping[str, Check] = {"file": _maybe_text, "line": _maybe_whole}
_PLAN = _fields(
    {"id": _id, "trigger": _text},
    {"label": _maybe_text, "context": _maybe_text, "end": _maybe_whole, **_PLACE},
)
_STEP = _fields({"goal": _text}, {"step": _maybe_text, **_PLACE})
_OPTION = _fields({"plan": _id}, {"why": _maybe_text})

_RECORDS: Mapping[str, Check] = {
    "agent": _fields({"agent": _text, "state": _text}, {}),
    "artifact": _fields({"artifact": _text}, {"robot": _maybe_text}),
    "belief": _fields(
        {"agent": _text, "op": _text, "belief": _text}, {"cause": _maybe_whole, "intention": _id, **_PLACE}
    ),
    "cause": _fields(
        {"id": _whole, "kind": _text, "what": _text},
        {
            "parent": _maybe_whole,
            "at": _maybe_number,
            "agent": _maybe_text,
            "artifact": _maybe_text,
            "topic": _maybe_text,
            "intention": _id,
            "plan": _id,
            **_PLACE,
        },
    ),
    "deliberation": _fields(
        {"id": _whole, "agent": _text, "trigger": _text},
        {
            "parent": _maybe_whole,
            "intention": _id,
            "chosen": _id,
            "options": _list(_OPTION),
            "untried": _list(_id),
        },
    ),
    "ended": _fields({}, {"code": _maybe_whole}),
    "goal": _fields(
        {"agent": _text, "goal": _text, "state": _text}, {"id": _id, "intention": _id, "why": _maybe_text}
    ),
    "intention": _fields(
        {"agent": _text, "id": _id, "state": _text},
        {"stack": _list(_STEP), "waits": _maybe_text, "since": _maybe_number, "reason": _maybe_text},
    ),
    "message": _fields(
        {"id": _id, "from": _text, "to": _text, "performative": _text, "content": _text},
        {"state": _maybe_text, "cause": _maybe_whole, "reply_to": _id},
    ),
    "operation": _fields(
        {"id": _whole, "artifact": _text, "operation": _text, "state": _text},
        {
            "agent": _maybe_text,
            "reason": _maybe_text,
            "term": _maybe_text,
            "cause": _maybe_whole,
            "outputs": _list(_maybe_text),
        },
    ),
    "program": _fields({"agent": _text, "plans": _list(_PLAN)}, {"rules": _list(_text)}),
    "source": _fields({"file": _text, "text": _text}, {}),
}


def is_well_formed(event: str, data: object) -> bool:
    """Return whether a record has the fields that its kind needs. Records of other kinds need only be mappings."""
    check = _RECORDS.get(event)
    return isinstance(data, Mapping) if check is None else check(data)
