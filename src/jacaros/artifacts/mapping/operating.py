"""Operations of a mapped artifact: services, actions, parameters of nodes, and properties on demand."""

import asyncio
from collections.abc import Sequence
from typing import Any

from jacaros.artifacts.env.artifact import Out
from jacaros.artifacts.env.values import Atom, plain
from jacaros.artifacts.kit.acting import error_code, error_text
from jacaros.artifacts.kit.services import MESSAGES, failure_reason
from jacaros.artifacts.mapping.checking import check_answer, message_types
from jacaros.artifacts.mapping.declared import (
    FieldPart,
    OperationKind,
    OperationPart,
    Source,
    Success,
    read_path,
)
from jacaros.artifacts.mapping.decoding import Read, Unshowable, reader
from jacaros.artifacts.mapping.encoding import Fill, WrongValue, builder, fitting
from jacaros.artifacts.mapping.host import Host
from jacaros.artifacts.mapping.parameters import own_name, parameter_converter
from jacaros.artifacts.mapping.paths import getter
from jacaros.artifacts.mapping.publishing import Publishing
from jacaros.artifacts.mapping.topic_multiplexer import Updater, feedback_updater
from jacaros.artifacts.mapping.type_search import ask_type
from jacaros.files.yaml import Problem
from jacaros.ros.action_client import ActionClient
from jacaros.ros.errors import CapabilityMissing, NameInvalid, ParameterRefused, ParameterUnknown, RosError
from jacaros.ros.fields import FieldType
from jacaros.ros.services import Client


class Operations:
    """The operations of one artifact.

    Args:
        host: the artifact.
    """

    def __init__(self, host: Host) -> None:
        parts = host.part.operations
        self._runners = [_RUNNERS[part.kind](host, part) for part in parts]
        plain = {
            part.name: runner
            for part, runner in zip(parts, self._runners, strict=True)
            if host.part.arity(part) == 0
        }
        for part, runner in zip(parts, self._runners, strict=True):
            if isinstance(runner, _ActionOperation) and part.suspend == "pause":
                # The reader has checked that these operations are of the right kind.
                runner.switches = (plain[part.pause.text], plain[part.resume.text])

    async def run(self, number: int, inputs: Sequence[object], outs: Sequence[Out]) -> None:
        """Run the operation with this index in the file."""
        await self._runners[number].run(inputs, outs)


class _RemoteOperation:
    """Common code of services and actions: build a request, read the answer."""

    what = "service"

    def __init__(self, host: Host, part: OperationPart) -> None:
        self._host, self._part = host, part
        self._fill: Fill | None = None
        self._takes: list[Read] = []
        self._check = part.success
        if part.type_name is not None:
            self._open(part.type_name.text)

    def _open(self, type_name: str) -> None:
        host, part = self._host, self._part
        types = message_types(part.kind, type_name)
        problems: list[Problem] = []
        fill = builder(fitting(part, types[0], host.ros), types[0], host.ros, problems, host.adapted)
        check_answer(part, types[1], host.ros, problems)
        self._more(types, problems)
        if problems:
            host.report(problems)
            host.fail(f"`{part.name}` does not match the type {type_name}", "wrong_mapping", part.name)
        answer = FieldType(types[1])
        self._takes = [reader(field, answer, None, host.ros) for field in part.outputs]
        if part.success is None and not part.any_success and "success" in host.ros.fields(types[1]):
            self._check = Success(read_path("success"), part.place)
        self._connect(type_name)
        self._fill = fill

    def _more(self, types: tuple[str, ...], problems: list[Problem]) -> None:
        """Prepare further fields of a subclass."""

    def _connect(self, type_name: str) -> None:
        """Make the client."""

    async def _ready(self) -> None:
        if self._fill is None:
            self._open(await ask_type(self._host, self.what, self._part.target))

    def _fields(self, inputs: Sequence[object]) -> dict[str, Any]:
        assert self._fill is not None
        try:
            return self._fill(inputs, self._host.clock.now())
        except WrongValue as error:
            self._host.fail(str(error), "wrong_value", error.field)

    def _succeeded(self, answer: Any) -> bool:
        if self._check is None:
            return True
        found = plain(getter(self._check.path)(answer, 0))
        return bool(found == self._check.value)

    def _give(self, answer: Any, outs: Sequence[Out]) -> None:
        try:
            values = [value for take in self._takes for value in take(answer, answer, 0)]
        except Unshowable as error:
            self._host.fail(str(error), error.functor, error.path)
        for out, value in zip(outs, values, strict=True):
            out.set(value)


class _ServiceOperation(_RemoteOperation):
    """One operation with ``service``."""

    _client: Client

    def _connect(self, type_name: str) -> None:
        self._client = self._host.client(self._host.robot_topic(self._part.target.text), type_name)

    async def run(self, inputs: Sequence[object], outs: Sequence[Out]) -> None:
        """Call the service."""
        await self._ready()
        assert self._part.timeout is not None
        response = await self._host.call(self._client, self._part.timeout, **self._fields(inputs))
        self._check_success(response)
        self._give(response, outs)

    async def ready(self) -> None:
        """Know the type."""
        await self._ready()

    async def switch(self) -> None:
        """Call the service."""
        self._check_success(await self._client.call(self._fields(()), self._part.timeout))

    def _check_success(self, response: Any) -> None:
        if self._succeeded(response):
            return
        name = self._client.name
        text = next((str(getattr(response, each)) for each in MESSAGES if getattr(response, each, "")), "")
        told = f": {text}" if text else ""
        self._host.fail(f"service {name} refused{told}", "service_refused", Atom(name.lstrip("/")), text)


NOT_SHOWN = Atom("unknown")
"""Replaces a value of a failed goal's result that agents cannot have, such as NaN."""


class _ActionOperation(_RemoteOperation):
    """One operation with ``action``."""

    what = "action"
    _client: ActionClient

    def __init__(self, host: Host, part: OperationPart) -> None:
        self._updaters: list[Updater] = [feedback_updater(host, each) for each in part.feedback]
        self._under_way = 0
        self._code: Read | None = None
        self._aborted: list[Read] = []
        self.switches: tuple[_ServiceOperation | _SetParameter, ...] = ()
        super().__init__(host, part)

    def _more(self, types: tuple[str, ...], problems: list[Problem]) -> None:
        part, answer, ros = self._part, FieldType(types[1]), self._host.ros
        if not problems:
            self._code = None if part.code is None else reader(part.code, answer, None, ros)
            self._aborted = [reader(field, answer, None, ros) for field in part.aborted]
        for updater in self._updaters:
            updater.prepare(types[2], problems)

    def _connect(self, type_name: str) -> None:
        self._client = self._host.action_client(self._part.target.text, type_name)

    async def run(self, inputs: Sequence[object], outs: Sequence[Out]) -> None:
        """Run a goal to its end."""
        await self._ready()
        for each in self.switches:
            await each.ready()
        host, part = self._host, self._part
        pause, resume = (each.switch for each in self.switches) if self.switches else (None, None)
        result = await host.act(
            self._client,
            self._fields(inputs),
            timeout=part.timeout,
            on_feedback=self._updater if self._updaters else None,
            under_way=self._count if self._updaters else None,
            suspend=part.suspend,
            pause=pause,
            resume=resume,
            aborted=self._explain,
        )
        if not self._succeeded(result):
            text = error_text(result)
            code, *more = self._explain(result)
            told = f": {text}" if text else ""
            host.fail(f"action {self._client.name} did not succeed{told}", "aborted", code, text, *more)
        self._give(result, outs)

    def _explain(self, result: Any) -> tuple[object, ...]:
        """Return the error code of a result, and the further values that the mapping declares."""
        code = error_code(result) if self._code is None else self._shown(self._code, result)[0]
        return (code, *(value for take in self._aborted for value in self._shown(take, result)))

    def _shown(self, take: Read, result: Any) -> Sequence[object]:
        try:
            return take(result, result, 0)
        except Unshowable:
            return (NOT_SHOWN,)

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


class _ParameterOperation:
    """Common code of the operations on parameters of nodes."""

    def __init__(self, host: Host, part: OperationPart) -> None:
        self._host, self._part = host, part
        self._name = part.target.text if part.node else own_name(host, part.target.text)
        try:
            node = host.ros.resolve(host.robot_topic(part.node)) if part.node else None
            self._parameters = host.ros.parameters(node)
        except CapabilityMissing as error:
            host.fail(f"{part.name}: {error}", "ros_error", host.name)

    def _fail(self, error: RosError) -> None:
        node = Atom(self._parameters.node.lstrip("/"))
        if isinstance(error, ParameterUnknown):
            self._host.fail(str(error), "parameter_unknown", Atom(self._name))
        if isinstance(error, ParameterRefused):
            self._host.fail(str(error), "parameter_refused", Atom(self._name))
        self._host.fail(str(error), *failure_reason(error, node, self._part.timeout))


class _SetParameter(_ParameterOperation):
    """One operation with ``set_parameter``."""

    async def run(self, inputs: Sequence[object], outs: Sequence[Out]) -> None:
        """Set the parameter."""
        try:
            await self._host.step(self._set(self._value(inputs)))
        except RosError as error:
            self._fail(error)

    async def ready(self) -> None:
        """Do nothing: everything is known."""

    async def switch(self) -> None:
        """Set the parameter."""
        await self._set(self._value(()))

    async def _set(self, value: Any) -> None:
        # Agents do not distinguish 1 from 1.0, but nodes do.
        if isinstance(value, int) and not isinstance(value, bool):
            try:
                if isinstance(await self._parameters.get(self._name, self._part.timeout), float):
                    value = float(value)
            except ParameterUnknown:
                pass  # setting it gives a better error
        await self._parameters.set(self._name, value, self._part.timeout)

    def _value(self, inputs: Sequence[object]) -> Any:
        part = self._part.values[0]
        if part.source is Source.NOW:
            return self._host.clock.now()
        value = inputs[part.parameter] if part.source is Source.PARAMETER else part.value
        known = {name: number for number, name in part.conversion.names}
        if isinstance(value, str) and value in known:
            return known[value]
        if (line := part.conversion.line) is not None:
            if isinstance(value, bool) or not isinstance(value, int | float):
                self._host.fail(
                    f"parameter `{self._name}`: expected a number, found {value!r}",
                    "parameter_refused",
                    Atom(self._name),
                )
            return line.back(value)
        return str(value) if isinstance(value, Atom) else value


class _GetParameter(_ParameterOperation):
    """One operation with ``get_parameter``."""

    async def run(self, inputs: Sequence[object], outs: Sequence[Out]) -> None:
        """Give the parameter."""
        field: FieldPart = self._part.outputs[0]
        try:
            value = await self._host.step(self._parameters.get(self._name, self._part.timeout))
        except (RosError, NameInvalid) as error:
            self._fail(error)
        else:
            try:
                outs[0].set(parameter_converter(field.conversion, self._name)(value))
            except Unshowable as error:
                self._host.fail(f"{error}: {error.help}", error.functor, error.path)


class _RequestOperation:
    """One operation with ``refresh`` or ``read``."""

    def __init__(self, host: Host, part: OperationPart) -> None:
        self._host, self._part = host, part

    async def run(self, inputs: Sequence[object], outs: Sequence[Out]) -> None:
        """Show the newest values, or give them to the caller."""
        for wanted in self._part.properties:
            reading = self._host.readings[wanted.text]
            if self._part.kind is OperationKind.REFRESH:
                await self._host.refresh(wanted.text, reading, "no_message")
            else:
                for out, value in zip(outs, await self._host.newest(reading, "no_message"), strict=True):
                    out.set(value)


_RUNNERS: dict[OperationKind, Any] = {
    OperationKind.PUBLISH: Publishing,
    OperationKind.SERVICE: _ServiceOperation,
    OperationKind.ACTION: _ActionOperation,
    OperationKind.SET: _SetParameter,
    OperationKind.GET: _GetParameter,
    OperationKind.REFRESH: _RequestOperation,
    OperationKind.READ: _RequestOperation,
}
