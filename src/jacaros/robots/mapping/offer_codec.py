"""Read and build the messages of offers: goals, results, feedback and beliefs."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from jacaros.robots.mapping.checking import known
from jacaros.robots.mapping.decoding import Read, reader
from jacaros.robots.mapping.encoding import Fill, builder
from jacaros.robots.mapping.interfaces import Interfaces, tried
from jacaros.robots.mapping.offers import OfferPart
from jacaros.robots.ros.fields import FieldType
from jacaros.robots.ros.names import feedback_type, goal_type, result_type
from jacaros.runtime.files.yaml import Problem


@dataclass(frozen=True, slots=True)
class OfferCodec:
    """Reads and builds the messages of an offer."""

    part: OfferPart
    _reads: tuple[tuple[str, Read], ...]
    _result: Fill
    _feedback: Fill
    _message: Fill

    def arguments(self, request: Any) -> dict[str, Any]:
        """Return the arguments of a goal message by name. Raises `Unshowable`."""
        found = {name: read(request, request, 0) for name, read in self._reads}
        return {name: _plain(values[0] if len(values) == 1 else values) for name, values in found.items()}

    def result(self, values: Mapping[str, Any], now: float) -> dict[str, Any]:
        """Return the fields of a result. Raises `WrongValue`."""
        return self._result([values.get(each) for each in self.part.result.names], now)

    def feedback(self, values: Mapping[str, Any], now: float) -> dict[str, Any]:
        """Return the fields of feedback. Raises `WrongValue`."""
        return self._feedback([values.get(each) for each in self.part.feedback.names], now)

    def message(self, values: Mapping[str, Any], now: float) -> dict[str, Any]:
        """Return the fields of a belief's message. Raises `WrongValue`."""
        return self._message([values.get(each) for each in self.part.fields.names], now)


def _plain(value: object) -> object:
    """Return a value as JSON data."""
    if isinstance(value, list | tuple):
        return [_plain(each) for each in value]
    return str(value) if isinstance(value, str) else value


def codec_of(part: OfferPart, interfaces: Interfaces, problems: list[Problem]) -> OfferCodec | None:
    """Return what reads and builds the messages of an offer; None after adding to *problems*."""
    name, before = part.type_name.text, len(problems)
    parts = (goal_type(name), result_type(name), feedback_type(name)) if part.is_action else (name,)
    if not known(part.type_name, parts[0], interfaces, problems):
        return None
    root = FieldType(parts[0])
    reads = [
        (argument, tried(field.place, problems, reader, field, root, None, interfaces))
        for argument, field in part.goal
    ]
    fills = [
        builder(built.values, parts[min(number, len(parts) - 1)], interfaces, problems)
        for number, built in ((1, part.result), (2, part.feedback), (0, part.fields))
    ]
    if len(problems) > before:
        return None
    found = tuple((argument, read) for argument, read in reads if read is not None)
    result, feedback, message = (fill or _empty for fill in fills)
    return OfferCodec(part, found, result, feedback, message)


def _empty(arguments: object, now: float) -> dict[str, Any]:
    return {}


def offer_problems(offers: Mapping[str, OfferPart], interfaces: Interfaces) -> list[Problem]:
    """Return the mistakes that appear when offers are compared with the message types that they name."""
    problems: list[Problem] = []
    for part in offers.values():
        codec_of(part, interfaces, problems)
    return problems
