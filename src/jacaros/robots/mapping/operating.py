"""Operations of a mapped artifact: messages, services, actions, parameters of nodes, and properties on demand.

A robot that was sent a velocity is always sent zero at the end.
"""

import asyncio
import math
from collections.abc import Iterator, Sequence
from typing import Any, NoReturn

from jacaros.artifacts.env.arbiter import WHEELS
from jacaros.artifacts.env.artifact import Out
from jacaros.artifacts.env.values import Atom, Structure
from jacaros.robots.artifacts.driving import Aborted, Driving, Motions, motions_of
from jacaros.robots.kit.acting import error_code, error_text, missing_number
from jacaros.robots.kit.connection import Matching
from jacaros.robots.kit.services import failure_reason, refusal, set_parameter
from jacaros.robots.mapping.checking import Codec, codec, message_types
from jacaros.robots.mapping.decoding import Unshowable
from jacaros.robots.mapping.encoding import WrongValue
from jacaros.robots.mapping.host import MappingHost, ask_type
from jacaros.robots.mapping.mapped_topic import Updater
from jacaros.robots.mapping.operations import OperationKind, OperationPart, ValueSource
from jacaros.robots.mapping.parameters import own_name
from jacaros.robots.ros.action_client import ActionClient
from jacaros.robots.ros.errors import (
    CapabilityMissing,
    MessageMismatch,
    RosError,
)
from jacaros.robots.ros.guarded import VELOCITIES
from jacaros.robots.ros.node import Publisher
from jacaros.robots.ros.qos import DEFAULT_QOS
from jacaros.robots.ros.services import Client
from jacaros.runtime.files.yaml import Problem


class _Operation:
    """An operation with a message, whose type may have to be looked up in the graph."""

    what = "service"

    def __init__(self, host: MappingHost, part: OperationPart) -> None:
        self._host, self._part = host, part
        self._known: Codec | None = None
        if part.type_name is not None:
            self._open(part.type_name.text)

    def _open(self, type_name: str) -> None:
        host, part = self._host, self._part
        problems: list[Problem] = []
        known = codec(part, type_name, host.ros, problems, host.adapted)
        self._prepare(type_name, problems)
        if problems:
            host.report(problems)
            host.fail(f"`{part.name}` does not match the type {type_name}", "wrong_mapping", part.name)
        self._connect(type_name)
        self._known = known

    def _prepare(self, type_name: str, problems: list[Problem]) -> None:
        """Prepare what only some operations have."""

    def _connect(self, type_name: str) -> None:
        raise NotImplementedError

    @property
    def _codec(self) -> Codec:
        assert self._known is not None
        return self._known

    async def ready(self) -> None:
        if self._known is None:
            self._open(await ask_type(self._host, self.what, self._part.target))

    def _fields(self, inputs: Sequence[object]) -> dict[str, Any]:
        try:
            return self._codec.fill(inputs, self._host.clock.now())
        except WrongValue as error:
            self._host.fail(str(error), "wrong_value", error.field)

    def _give(self, answer: Any, outs: Sequence[Out]) -> None:
        try:
            values = [value for take in self._codec.outputs for value in take(answer, answer, 0)]
        except Unshowable as error:
            self._host.fail(str(error), error.functor, error.path)
        for out, value in zip(outs, values, strict=True):
            out.set(value)

    def _refuse(self, message: str, usual: str, *arguments: object) -> NoReturn:
        """Fail because the answer shows no success, with the reason that the mapping declares, or the usual one."""
        success = self._part.success
        if success is not None and success.reason is not None:
            self._host.fail(message, success.reason)
        self._host.fail(message, usual, *arguments)


class _ServiceOperation(_Operation):
    _client: Client

    def _connect(self, type_name: str) -> None:
        self._client = self._host.client(self._host.robot_topic(self._part.target.text), type_name)

    async def run(self, inputs: Sequence[object], outs: Sequence[Out]) -> None:
        await self.ready()
        assert self._part.timeout is not None
        response = await self._host.call(self._client, self._part.timeout, **self._fields(inputs))
        if not self._codec.succeeded(response):
            name = self._client.name
            message, text = refusal(name, response)
            self._refuse(message, "service_refused", Atom(name.lstrip("/")), text)
        self._give(response, outs)


class _ActionOperation(_Operation):
    what = "action"
    _client: ActionClient

    def __init__(self, host: MappingHost, part: OperationPart) -> None:
        self._updaters = [Updater(host, each) for each in part.feedback]
        self._under_way = 0
        super().__init__(host, part)

    def _prepare(self, type_name: str, problems: list[Problem]) -> None:
        for updater in self._updaters:
            updater.prepare(message_types(self._part.kind, type_name)[2], problems)

    def _connect(self, type_name: str) -> None:
        self._client = self._host.action_client(self._part.target.text, type_name)

    async def run(self, inputs: Sequence[object], outs: Sequence[Out]) -> None:
        await self.ready()
        host, part = self._host, self._part
        result = await host.act(
            self._client,
            self._fields(inputs),
            timeout=part.timeout,
            on_feedback=self._updater if self._updaters else None,
            under_way=self._count if self._updaters else None,
            suspend=part.suspend,
        )
        if not self._codec.succeeded(result):
            text = error_text(result)
            told = f"action {self._client.name} did not succeed{f': {text}' if text else ''}"
            self._refuse(told, "aborted", error_code(result), text)
        self._give(result, outs)

    def _count(self, begins: bool) -> None:
        self._under_way += 1 if begins else -1
        if not self._under_way:
            # Later, because an operation started by a failing step is discarded.
            asyncio.get_running_loop().call_soon(self._withdraw)

    def _updater(self, message: Any) -> None:
        for updater in self._updaters:
            updater.take_message(message, None, self._client.name)

    def _withdraw(self) -> None:
        if not self._under_way:
            for updater in self._updaters:
                updater.withdraw()


class _PublishOperation(_Operation):
    what = "topic"

    _publisher: Publisher
    _matching: Matching

    def __init__(self, host: MappingHost, part: OperationPart) -> None:
        self._motions = Motions()
        self._drives = self._moves = self._moved = False
        self._arguments: Sequence[object] = ()
        super().__init__(host, part)

    def _connect(self, type_name: str) -> None:
        host, part = self._host, self._part
        self._publisher = host.publisher(part.target.text, type_name, part.qos or DEFAULT_QOS)
        self._matching = host.matching_of(self._publisher, self._warn_unmatched)
        self._drives = type_name in VELOCITIES
        if self._drives:
            self._motions = motions_of(host.ros, host.robot_prefix)
            self._motions.watch(host, self._stand, self._halt)

    async def run(self, inputs: Sequence[object], outs: Sequence[Out]) -> None:
        await self.ready()
        if self._part.rate is not None:
            await self._repeat(inputs, self._seconds(inputs), 1.0 / self._part.rate)
            return
        stops = self._motions.stops
        for pause in self._pauses(inputs):
            await self._host.sleep(pause)
            await self._host.pause_point()
            if self._motions.stops != stops:
                self._host.fail(f"`{self._part.name}` was aborted", "aborted", 0.0)
        self._send(inputs)

    def _pauses(self, inputs: Sequence[object]) -> Iterator[float]:
        """Yield pauses until messages arrive; a message that stops a robot does not wait."""
        if self._matching.exists() or (self._drives and not self._filled(inputs)[1]):
            return iter(())
        return self._matching.pauses(always=self._drives)

    def _seconds(self, inputs: Sequence[object]) -> float:
        duration = self._part.duration
        assert duration is not None
        value = inputs[duration.parameter] if duration.source is ValueSource.PARAMETER else duration.value
        if isinstance(value, bool) or not isinstance(value, int | float) or not 0 <= value < math.inf:
            text = f"expected a number of seconds as duration, found {value!r}"
            self._host.fail(text, "wrong_value", "duration")
        return float(value)

    async def _repeat(self, inputs: Sequence[object], seconds: float, period: float) -> None:
        """Publish until the time is over. Pauses do not count, and the motions of one robot take turns."""
        host, left = self._host, seconds
        pauses = self._pauses(inputs) if seconds > 0.0 else iter(())
        # Without wheels, two calls of the same operation exclude each other.
        use = WHEELS if self._drives else f"{host.current.request.artifact.path}.{self._part.name}"
        driving = Driving(host, self._motions, use, lambda: self._end(inputs))
        try:
            with driving:
                await driving.ready()
                for pause in pauses:
                    await driving.pass_time(pause)
                    await driving.ready()
                while left > 1e-9:
                    await driving.ready()
                    began, driving.gap = host.clock.elapsed, None
                    self._send(inputs)
                    await driving.pass_time(min(period, left))
                    left -= host.clock.elapsed - began
                    self._heed_gap(driving.gap, seconds - left)
        except Aborted:
            host.fail(f"`{self._part.name}` was aborted", "aborted", round(seconds - left, 3))

    def _heed_gap(self, gap: Structure | Atom | None, covered: float) -> None:
        """Fail if the robot was not watched for a while."""
        if gap is not None and self._drives:
            text = f"the open-loop motion `{self._part.name}` was interrupted ({gap})"
            self._host.fail(text, "interrupted", round(covered, 3))

    def _warn_unmatched(self, message: str, help: str) -> None:
        """Log once that a topic has no subscribers: its name or type may be wrong."""
        self._host.report_once((self._publisher.topic, "unmatched"), self._part.target.place, message, help)

    def _filled(self, inputs: Sequence[object]) -> tuple[Any, bool]:
        """Return the fields of the message, and whether it moves the robot."""
        fields = self._fields(inputs)
        missing = missing_number(fields)
        if missing is not None:
            self._host.fail(f"field `{missing}` is not a number; nothing was sent", "wrong_value", missing)
        moves = self._codec.end is not None and any(_numbers(fields))
        if moves and not all(map(math.isfinite, _numbers(fields))):
            self._host.fail("the velocity is infinite; nothing was sent", "wrong_value", "velocity")
        return fields, moves

    def _send(self, inputs: Sequence[object]) -> None:
        self._arguments = inputs
        fields, moves = self._filled(inputs)
        try:
            message = self._publisher.message(**fields)
            self._moved = self._moved or moves
            self._publisher.publish(message)
        except MessageMismatch as error:
            self._host.fail(str(error), "wrong_value", error.field)
        self._moves = moves
        if self._drives and not moves:
            self._motions.stops += 1

    def _end(self, inputs: Sequence[object]) -> None:
        if (end := self._codec.end) is not None:
            self._moves = False
            self._publisher.publish(self._publisher.message(**end(inputs, self._host.clock.now())))

    def _halt(self) -> None:
        """Stop the robot when the artifact ends."""
        if self._moves:
            self._end(self._arguments)

    def _stand(self) -> None:
        """Stop a robot that was ever sent a velocity when the process ends. This may run in a thread, so it only
        publishes."""
        if self._moved:
            self._end(self._arguments)


def _numbers(fields: Any) -> list[float]:
    if isinstance(fields, dict):
        return [number for name, each in fields.items() if name != "header" for number in _numbers(each)]
    if isinstance(fields, list | tuple):
        return [number for each in fields for number in _numbers(each)]
    return [float(fields)] if isinstance(fields, int | float) else []


class _SetParameter:
    def __init__(self, host: MappingHost, part: OperationPart) -> None:
        self._host, self._part = host, part
        self._name = part.target.text if part.node else own_name(host, part.target.text)
        try:
            node = host.ros.resolve(host.robot_topic(part.node)) if part.node else None
            self._parameters = host.ros.parameters(node)
        except CapabilityMissing as error:
            host.fail(f"{part.name}: {error}", "ros_error", host.name)

    async def run(self, inputs: Sequence[object], outs: Sequence[Out]) -> None:
        try:
            setting = set_parameter(self._parameters, self._name, self._value(inputs), self._part.timeout)
            await self._host.step(setting)
        except RosError as error:
            node = Atom(self._parameters.node.lstrip("/"))
            reason = failure_reason(error, node, self._part.timeout, Atom(self._name))
            self._host.fail(str(error), *reason)

    def _value(self, inputs: Sequence[object]) -> Any:
        part = self._part.values[0]
        if part.source is ValueSource.NOW:
            return self._host.clock.now()
        value = inputs[part.parameter] if part.source is ValueSource.PARAMETER else part.value
        known = {name: number for number, name in part.conversion.names}
        if isinstance(value, str) and value in known:
            return known[value]
        if (line := part.conversion.line) is not None:
            if isinstance(value, bool) or not isinstance(value, int | float):
                text = f"parameter `{self._name}`: expected a number, found {value!r}"
                self._host.fail(text, "parameter_refused", Atom(self._name))
            return line.back(value)
        return str(value) if isinstance(value, Atom) else value


class _RequestOperation:
    def __init__(self, host: MappingHost, part: OperationPart) -> None:
        self._host, self._part = host, part

    async def run(self, inputs: Sequence[object], outs: Sequence[Out]) -> None:
        """Show the newest values."""
        for wanted in self._part.properties:
            reading = self._host.readings[wanted.text]
            await self._host.refresh(wanted.text, reading, "no_message")


_RUNNERS: dict[OperationKind, Any] = {
    OperationKind.PUBLISH: _PublishOperation,
    OperationKind.SERVICE: _ServiceOperation,
    OperationKind.ACTION: _ActionOperation,
    OperationKind.SET: _SetParameter,
    OperationKind.REFRESH: _RequestOperation,
}


def runners_of(host: MappingHost) -> list[Any]:
    """Return what runs the operations of an artifact, in the order of the file."""
    return [_RUNNERS[part.kind](host, part) for part in host.part.operations]
