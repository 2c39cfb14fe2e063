"""Creating artifacts: names, types, arguments and creators."""

import pytest
from creation_lab import Counter, Fussy, Slow, why

from jacaros.artifacts import Artifact, Atom, UnknownArtifact
from jacaros.runtime.errors import InternalError


class Labelled(Artifact):
    def init(self, label: str, size: int):
        self.define_property("label", label)
        self.define_property("size", size)


class Bare(Artifact):
    pass


def types(stage):
    stage.types = {"Counter": Counter, "Labelled": Labelled, "Fussy": Fussy, "Slow": Slow, "Nonsense": int}


async def test_init_has_the_arguments_of_make_artifact(stage):
    types(stage)
    a = await stage.main.make_artifact("a", "Counter")
    b = await stage.main.make_artifact(Atom("b"), Atom("Counter"), [7])
    c = await stage.main.make_artifact("c", "Labelled", ("kitchen", 12.0), "bob")
    assert [stage.property(each, "count") for each in (a, b)] == [(0,), (7,)]
    assert (stage.property(c, "label"), stage.property(c, "size")) == (("kitchen",), (12,))
    assert (c.name, c.type_name, c.workspace, c.creator, c.path) == (
        "c",
        "Labelled",
        "/main",
        "bob",
        "/main/c",
    )
    assert type(b.name) is str
    assert stage.main.lookup("b") is b
    assert a.number < b.number < c.number
    assert repr(c) == "</main/c: Labelled>"


async def test_an_artifact_without_init_is_made_without_arguments_only(stage):
    await stage.make(Bare)
    reason, name, message = await why(stage.make(Bare, 1, name="other"))
    assert (reason, name) == ("init_failed", "other")
    assert "expected () as arguments of init, found 1 arguments" in message


async def test_without_arguments_an_artifact_is_made_even_if_its_init_wants_some(stage):
    fussy = await stage.make(Fussy)
    assert stage.main.properties(fussy) == ()
    assert stage.lines == []


async def test_an_unknown_type_is_refused_with_a_suggestion(stage):
    types(stage)
    reason, name, message = await why(stage.main.make_artifact("d", "Cuonter"))
    assert (reason, name) == ("unknown_artifact_template", "Cuonter")
    assert "did you mean `Counter`?" in message
    with pytest.raises(UnknownArtifact):
        stage.main.lookup("d")


async def test_without_find_type_no_type_name_is_known(stage):
    environment = type(stage.environment)(stage.clock)
    reason, _, message = await why(environment.workspace("/main").make_artifact("d", "Counter"))
    assert reason == "unknown_artifact_template"
    assert "unknown artifact type `Counter`" in message


async def test_a_type_that_is_not_an_artifact_or_cannot_be_loaded_is_refused(stage):
    types(stage)
    reason, name, message = await why(stage.main.make_artifact("d", "Nonsense"))
    assert (reason, name) == ("unknown_artifact_template", "Nonsense")
    assert "not a subclass of Artifact" in message

    def broken(name):
        raise SyntaxError("in artifacts.py")

    environment = type(stage.environment)(stage.clock, {}, broken, stage.lines.append)
    reason, _, message = await why(environment.workspace("/main").make_artifact("d", "Counter"))
    assert reason == "unknown_artifact_template"
    assert "SyntaxError: in artifacts.py" in message
    assert stage.logged("SyntaxError: in artifacts.py")

    def defect(name):
        raise InternalError("ours")

    environment = type(stage.environment)(stage.clock, {}, defect)
    with pytest.raises(InternalError):
        await environment.workspace("/main").make_artifact("d", "Counter")
