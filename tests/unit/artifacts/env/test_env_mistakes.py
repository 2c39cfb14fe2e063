"""Errors of an artifact's author that were once silent, or reported without a fix."""

import asyncio

import pytest

from jacaros.artifacts import Artifact, InvalidArtifact, OperationFailed, Out, internal_operation, operation


def made(**members):
    return type("Made", (Artifact,), {"__module__": __name__, **members})


@pytest.mark.parametrize("ports", ["out", (1,)])
def test_ports_are_a_tuple_of_names(ports):
    with pytest.raises(InvalidArtifact, match=r'expected a tuple of names as .*; write ports = \("out",\)'):
        made(ports=ports)


class Careless(Artifact):
    def init(self):
        self.define_property("room", "k", 1)

    @operation
    def hide(self):
        self.value = 3

    @operation
    async def forget(self):
        self.rest()

    @operation
    async def rest(self):
        await self.sleep(1)

    @operation
    def begin(self):
        self.start(self.tell)

    @internal_operation
    def tell(self):
        self.signal_to(self.caller, "x")

    @operation
    def where(self):
        self.update_property("room", "h", 5, where=("h",))

    @operation
    def index(self):
        self.update_value("room", 5, 1)

    @operation
    def get(self, x): ...

    @operation
    def begin_unmarked(self):
        self.start(self.unmarked)

    async def unmarked(self): ...

    @operation
    def undefined(self):
        self.update_property("on", True)


pytestmark = pytest.mark.makes(it=Careless)


@pytest.mark.parametrize(
    ("operation_name", "arguments", "told"),
    [
        ("hide", (), "self.value = ... would replace a part of Artifact; choose another name"),
        ("where", (), "expected 2 values of property room, found 1: ('h',); None matches any value"),
        ("index", (), "property room has 2 values, so index 5 is out of range (the first index is 0)"),
        (
            "get",
            (Out(),),
            "give it a value before the call, or, for an output, annotate the parameter: `x: Out`",
        ),
        ("begin_unmarked", (), "add @internal_operation above def unmarked"),
        ("undefined", (), 'add it with self.define_property("on", ...)'),
    ],
)
async def test_an_error_of_an_author_is_reported_with_a_fix(stage, it, operation_name, arguments, told):
    assert told in stage.call(it, operation_name, *arguments).outcome.message


async def test_an_operation_called_without_await_is_reported(stage, it):
    assert (await stage.call(it, "rest").wait()).ok
    assert stage.logged("self.rest() has no effect without await")


async def test_a_signal_without_an_agent_is_reported(stage, it):
    assert stage.call(it, "begin").ok
    await asyncio.sleep(0)
    assert any("self.caller is None in internal operations" in line for line in stage.lines)


async def test_an_unknown_annotation_is_reported_once_and_a_later_definition_counts(stage):
    names = {"__name__": __name__, "Artifact": Artifact, "operation": operation}
    exec(
        "class Late(Artifact):\n"
        "    @operation\n    def put(self, x: 'NoSuch'): ...\n"
        "    @operation\n    def place(self, x: 'Room'): ...\n"
        "Room = int\n",
        names,
    )
    for name in ("a", "b"):
        made = await stage.make(names["Late"], name=name)
    (told,) = [line for line in stage.lines if "accepts any value" in line]
    assert told.startswith("[Late] parameter x of Late.put accepts any value: unknown annotation 'NoSuch';")
    assert "expected an integer" in stage.call(made, "place", "hall").outcome.message
    assert stage.call(made, "put", "hall").ok


async def test_a_missing_port_can_be_caught(stage):
    class Speaker(Artifact):
        ports = ("out",)

        @operation
        async def say(self, result: Out[str]):
            try:
                await self.call_linked("outt", "on")
            except OperationFailed as failure:
                result.set(f"{failure.message} {failure.reason}")

    result = Out()
    assert (await stage.call(await stage.make(Speaker), "say", result).wait()).ok
    assert result.value.endswith('; its ports are out operation_error("say/1")')


async def test_a_value_of_another_class_is_an_error(stage):
    class Typed(Artifact):
        def init(self):
            self.define_property("free", 3)

        @operation
        def ask(self, free: Out[bool]):
            free.set(self.value("free", kind=int) > 0)

        @operation
        def ask_wrongly(self):
            self.value("free", kind=str)

    typed, free = await stage.make(Typed), Out()
    assert stage.call(typed, "ask", free).ok
    assert free.value is True
    assert (
        "expected str at index 0 of property free, found 3"
        in stage.call(typed, "ask_wrongly").outcome.message
    )


class Copying(Artifact):
    def init(self):
        self.define_property("path", [])

    @operation
    async def add(self, x):
        self.value("path").append(x)

    @operation
    def add_rightly(self, x):
        path = self.value("path")
        path.append(x)
        self.update_property("path", path)

    @operation
    def look(self, last: Out):
        last.set(self.value("path").pop())


async def test_a_change_of_a_copy_is_reported_once(stage):
    await stage.make(Copying, name="a")
    copying = await stage.make(Copying, name="b")
    (told,) = [line for line in stage.lines if "changes only a copy" in line]
    assert told.startswith("[Copying] in Copying.add (line ")
    assert "): self.value('path').append(x) changes only a copy of the value" in told
    assert stage.call(copying, "add_rightly", 3).ok
    assert stage.property(copying, "path") == ([3],)
