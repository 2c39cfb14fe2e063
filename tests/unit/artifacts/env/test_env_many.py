"""Many artifacts: finding one needs no search, and disposed ones leave nothing behind."""

import gc

from jacaros.artifacts import Artifact, operation
from jacaros.artifacts.env.workspace import chosen_artifact
from jacaros.artifacts.kernel.declaration import OperationTable
from jacaros.artifacts.kernel.steps import Steps

MANY = 300


class Lamp(Artifact):
    """A lamp with many wires."""

    ports = ("next",)

    def init(self):
        self.define_property("lit", 0)

    @operation
    def ping(self):
        self.update_property("lit", 1)

    @operation
    def flash(self, number):
        name = f"flash{number}"
        self.define_property(name, number)
        self.signal("flashing")  # what has been defined becomes known
        self.remove_property(name)


class Counted:
    """How often the operations of an artifact are looked through."""

    def __init__(self, monkeypatch):
        self.looks = 0
        find = OperationTable.find

        def counted(table, name, arity):
            self.looks += 1
            return find(table, name, arity)

        monkeypatch.setattr(OperationTable, "find", counted)


def alive(kind):
    gc.collect()
    return sum(type(each) is kind for each in gc.get_objects())


async def test_an_artifact_is_chosen_without_searching_all_others(stage, monkeypatch):
    counted = Counted(monkeypatch)
    for number in range(MANY):
        made = await stage.make(Lamp, name=f"lamp{number}")
        assert len(stage.main.providers("println", 1)) == 1
        assert len(stage.main.providers("ping", 0)) == number + 1
        assert made in stage.main.providers("ping", 0)
    assert counted.looks < 10 * MANY
    for number in range(MANY):
        stage.main.dispose_artifact(stage.main.lookup(f"lamp{number}"))
        assert len(stage.main.providers("ping", 0)) == MANY - number - 1
    assert counted.looks < 20 * MANY


async def test_among_many_an_own_artifact_is_chosen_then_the_one_focused_first(stage):
    made = []
    for number in range(MANY):
        stage.main.create(
            f"lamp{number}", Lamp, (), f"agent{number % 10}", lambda found, _: made.append(found)
        )

    def chosen(own, focused=()):
        return chosen_artifact([stage.main], "ping", 0, own, focused)

    assert (chosen("agent0"), chosen("agent7")) == (made[0], made[7])
    assert chosen("other") is made[0]
    assert chosen("other", (made[9], made[3])) is made[9]
    assert chosen("agent5", (made[9],)) is made[5]
    stage.main.dispose_artifact(made[7])
    assert chosen("agent7") is made[17]


async def test_disposed_artifacts_leave_nothing_behind(stage):
    gone = []
    stage.environment.when_disposed(gone.append)
    hub = await stage.make(Lamp, name="hub")
    registry = stage.main._registry
    before = alive(Steps)
    for number in range(MANY):
        lamp = await stage.make(Lamp, name=f"lamp{number}")
        stage.main.link(hub, "next", lamp)
        stage.main.link(lamp, "next", hub)
        stage.main.link(lamp, "next", lamp)
        watcher = stage.watch(lamp)
        assert watcher.notes == ["+lit(0)"]
        stage.main.dispose_artifact(lamp)
    assert stage.main.linked(hub, "next") == ()
    assert len(gone) == MANY
    assert (registry._links, registry._ending) == ({}, [])
    del lamp, watcher
    assert alive(Steps) <= before + 1


async def test_a_removed_watcher_of_a_workspace_is_forgotten(stage):
    before = len(stage.main._watchers)
    ends = [stage.main.watch(lambda artifact, present: None) for _ in range(MANY)]
    for end in ends:
        end()
        end()
    assert len(stage.main._watchers) == before


async def test_names_of_removed_properties_are_forgotten(stage):
    lamp = await stage.make(Lamp, name="lamp")
    for number in range(MANY):
        assert stage.call(lamp, "flash", number).ok
    assert list(stage.main._steps_of(lamp).publication.properties._by_name) == ["lit"]
