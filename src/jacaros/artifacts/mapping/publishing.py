"""Operations that publish, once or repeatedly. A robot that was sent a velocity is always sent zero at the end."""

import math
from collections.abc import Iterator, Sequence
from typing import Any

from jacaros.artifacts.env.artifact import Out
from jacaros.artifacts.env.execution import OperationExecution
from jacaros.artifacts.env.values import Atom, Structure
from jacaros.artifacts.kit.acting import missing_number
from jacaros.artifacts.kit.connection import Matching
from jacaros.artifacts.mapping.declared import OperationPart, Source, ValuePart
from jacaros.artifacts.mapping.encoding import Fill, WrongValue, builder, fitting
from jacaros.artifacts.mapping.host import Host
from jacaros.artifacts.mapping.type_search import ask_type
from jacaros.artifacts.resources.arbiter import WHEELS
from jacaros.artifacts.robots.motion_claim import Aborted, Driving, Motions, motions_of
from jacaros.files.yaml import Problem
from jacaros.ros.errors import MessageMismatch
from jacaros.ros.guarded import VELOCITIES, guarded_by
from jacaros.ros.node import Publisher
from jacaros.ros.qos import DEFAULT_QOS


class Publishing:
    """One operation with ``publish``.

    Args:
        host: the artifact.
        part: its declaration.
    """

    def __init__(self, host: Host, part: OperationPart) -> None:
        self._host, self._part = host, part
        self._publisher: Publisher | None = None
        self._matching: Matching | None = None
        self._fill: Fill | None = None
        self._fill_end: Fill | None = None
        self._motions = Motions()
        self._drives = self._moves = self._moved = False
        self._arguments: Sequence[object] = ()
        if part.type_name is not None:
            self._open(part.type_name.text)

    def _open(self, type_name: str) -> None:
        host, part = self._host, self._part
        problems: list[Problem] = []
        values = fitting(part, type_name, host.ros)
        self._fill = builder(values, type_name, host.ros, problems, host.adapted)
        if (end := self._end_values(type_name, values)) is not None:
            self._fill_end = builder(end, type_name, host.ros, problems, host.adapted)
        if problems:
            host.report(problems)
            host.fail(f"`{part.name}` does not match the type {type_name}", "wrong_mapping", part.name)
        self._publisher = host.publisher(part.target.text, type_name, part.qos or DEFAULT_QOS)
        self._matching = host.matching_of(
            self._publisher, part.match_timeout, part.unmatched, self._warn_unmatched
        )
        self._drives = type_name in VELOCITIES
        if self._drives:
            self._motions = motions_of(host.ros, host.robot_prefix)
            host.at_dispose(host.ros.add_exit_hook(self._stand))
            host.at_dispose(guarded_by(host.ros).on_standstill(self._stand))
            host.at_dispose(self._halt)

    def _end_values(self, type_name: str, values: tuple[ValuePart, ...]) -> tuple[ValuePart, ...] | None:
        """Return the values of the last message: velocities end with zero unless the mapping declares it."""
        if self._part.at_end is not None:
            return self._part.at_end
        if type_name not in VELOCITIES:
            return None
        return tuple(each for each in values if ".header" in each.target.steps)

    async def run(self, inputs: Sequence[object], outs: Sequence[Out]) -> None:
        """Publish, once or repeatedly."""
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
        self._send_once(inputs)

    def _pauses(self, inputs: Sequence[object]) -> Iterator[float]:
        """Yield pauses until messages arrive; a message that stops a robot does not wait."""
        assert self._matching is not None
        if self._matching.exists() or (self._drives and not self._filled(inputs)[1]):
            return iter(())
        return self._matching.pauses(always=self._drives)

    async def ready(self) -> None:
        """Look up the type."""
        if self._publisher is None:
            self._open(await ask_type(self._host, "topic", self._part.target))

    async def switch(self) -> None:
        """Publish once."""
        self._send_once(())

    def _send_once(self, inputs: Sequence[object]) -> None:
        self._send(inputs)
        if self._part.at_end is not None:
            self._end(inputs)

    def _seconds(self, inputs: Sequence[object]) -> float:
        duration = self._part.duration
        assert duration is not None
        value = inputs[duration.parameter] if duration.source is Source.PARAMETER else duration.value
        if isinstance(value, bool) or not isinstance(value, int | float) or not 0 <= value < math.inf:
            self._host.fail(
                f"expected a number of seconds as duration, found {value!r}", "wrong_value", "duration"
            )
        return float(value)

    async def _repeat(self, inputs: Sequence[object], seconds: float, period: float) -> None:
        """Publish until the time is over. Pauses do not count, and the motions of one robot take turns."""
        host, left = self._host, seconds
        pauses = self._pauses(inputs) if seconds > 0.0 else iter(())
        driving = Driving(host, self._motions, self._use(host.current), lambda: self._end(inputs))
        try:
            with driving:
                await driving.ready()
                for pause in pauses:
                    await driving.wait(pause)
                    await driving.ready()
                while left > 1e-9:
                    await driving.ready()
                    began, driving.claim.gap = host.clock.elapsed, None
                    self._send(inputs)
                    await driving.wait(min(period, left))
                    left -= host.clock.elapsed - began
                    self._heed_gap(driving.claim.gap, seconds - left)
        except Aborted:
            host.fail(f"`{self._part.name}` was aborted", "aborted", round(seconds - left, 3))

    def _heed_gap(self, gap: Structure | Atom | None, covered: float) -> None:
        """Fail if the robot was not watched for a while."""
        if gap is not None and self._drives:
            text = f"the open-loop motion `{self._part.name}` was interrupted ({gap})"
            self._host.fail(text, "interrupted", round(covered, 3))

    def _use(self, execution: OperationExecution) -> str:
        """Return the wheels, or a resource that makes two calls of the same operation exclude each other."""
        if self._drives:
            return WHEELS
        return f"{execution.request.artifact.path}.{self._part.name}"

    def _warn_unmatched(self, message: str, help: str) -> None:
        """Log once that a topic has no subscribers: its name or type may be wrong."""
        assert self._publisher is not None
        self._host.report_once((self._publisher.topic, "unmatched"), self._part.target.place, message, help)

    def _filled(self, inputs: Sequence[object]) -> tuple[Any, bool]:
        """Return the fields of the message, and whether it moves the robot."""
        assert self._fill is not None
        try:
            fields = self._fill(inputs, self._host.clock.now())
            missing = missing_number(fields)
            if missing is not None:
                raise WrongValue(f"field `{missing}` is not a number; nothing was sent", missing)
            moves = self._fill_end is not None and _is_motion(fields)
            if moves and not _is_finite(fields):
                raise WrongValue("the velocity is infinite; nothing was sent", "velocity")
        except WrongValue as error:
            self._host.fail(str(error), "wrong_value", error.field)
        return fields, moves

    def _send(self, inputs: Sequence[object]) -> None:
        assert self._publisher is not None
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
        """Publish the last message, if any."""
        if self._fill_end is None or self._publisher is None:
            return
        self._moves = False
        self._publisher.publish(self._publisher.message(**self._fill_end(inputs, self._host.clock.now())))

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


def _is_motion(fields: Any) -> bool:
    return any(number != 0.0 for number in _numbers(fields))


def _is_finite(fields: Any) -> bool:
    return all(map(math.isfinite, _numbers(fields)))
