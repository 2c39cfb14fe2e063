"""The tree of workspaces, their standard artifacts, and the lookup of artifacts."""

import pytest

from jacaros.artifacts import (
    Artifact,
    OperationFailed,
    Structure,
    UnknownArtifact,
    UnknownWorkspace,
    operation,
)


class Counter(Artifact):
    def init(self, start: int = 0):
        self.define_property("count", start)

    @operation
    def inc(self):
        self.update_property("count", self.value("count") + 1)


class Other(Artifact):
    @operation
    def inc(self): ...

    @operation
    def inc_any(self, *x: object): ...


async def test_workspaces_form_a_tree(stage):
    lab = stage.environment.create_workspace("/main/lab")
    inner = stage.environment.create_workspace("/main/lab/inner")
    assert (inner.path, inner.name) == ("/main/lab/inner", "inner")
    assert stage.environment.workspace("/main/lab") is lab
    assert [each.path for each in stage.environment.workspaces()] == ["/main", "/main/lab", "/main/lab/inner"]
    assert lab.lookup("console") is not stage.main.lookup("console")


async def test_a_workspace_that_exists_or_has_no_parent_is_refused(stage):
    with pytest.raises(OperationFailed, match="workspace `/main` already exists") as present:
        stage.environment.create_workspace("/main")
    assert present.value.reason == Structure("workspace_already_present", ("/main",))
    with pytest.raises(
        UnknownWorkspace, match=r"unknown workspace `/mian`; did you mean `/main`\?"
    ) as unknown:
        stage.environment.create_workspace("/mian/lab")
    assert unknown.value.reason == Structure("unknown_workspace", ("/mian",))
    with pytest.raises(UnknownWorkspace):
        stage.environment.workspace("/main/lab")


async def test_lookup_of_an_unknown_artifact_suggests_a_name(stage):
    await stage.make(Counter, name="battery")
    with pytest.raises(
        UnknownArtifact, match=r"unknown artifact `batery` in workspace /main; did you mean `battery`\?"
    ) as caught:
        stage.main.lookup("batery")
    assert caught.value.reason == Structure("artifact_not_available", ("batery",))


async def test_providers_of_an_operation_are_found_in_the_order_of_creation(stage):
    assert stage.main.providers("inc", 0) == ()
    first, second = await stage.make(Counter, name="a"), await stage.make(Other, name="b")
    assert stage.main.providers("inc", 0) == (first, second)
    assert stage.main.providers("inc", 0) == (first, second)
    assert stage.main.providers("inc_any", 3) == (second,)
    assert stage.main.providers("inc", 1) == ()
    stage.main.dispose_artifact(first)
    assert stage.main.providers("inc", 0) == (second,)


async def test_creation_and_disposal_can_be_watched(stage):
    seen = []
    stop = stage.main.watch(lambda artifact, present: seen.append((artifact.name, present)))
    counter = await stage.make(Counter)
    stage.main.dispose_artifact(counter)
    stop()
    stop()
    await stage.make(Counter)
    assert seen == [("it", True), ("it", False)]


@pytest.mark.expects_defects
async def test_a_broken_watcher_is_reported(stage):
    stop = stage.main.watch(lambda artifact, present: 1 / 0)
    await stage.make(Counter)
    stop()
    assert [type(error) for error in stage.defects] == [ZeroDivisionError]
