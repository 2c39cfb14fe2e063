"""The store of observable properties: names, templates, commits, roll-backs."""

from random import Random

import pytest

from jacaros.artifacts import Artifact, Atom, InvalidArtifact, Out, Structure, UnknownProperty, operation
from jacaros.artifacts.env import property as properties
from jacaros.artifacts.env.property import NO_CHANGES, PropertyStore


def contents(store):
    return [(p.name, p.values) for p in store.committed()]


def store_of(*properties):
    store = PropertyStore()
    for name, *values in properties:
        store.define(name, tuple(values), None)
    store.commit()
    return store


def test_several_updates_in_one_step_are_one_change_even_to_the_old_values():
    store = store_of(("count", 0))
    for number in (1, 2, 3):
        store.update("count", (number,), None)
    changes = store.commit()
    assert [(old.values, new.values) for old, new in changes.changed] == [((0,), (3,))]
    assert (changes.added, changes.removed) == ((), ())
    assert store.commit() is NO_CHANGES
    store.update("count", (3,), None)
    assert len(store.commit().changed) == 1
    for number in (1, 3):
        store.update("count", (number,), None, if_new=True)
    assert len(store.commit().changed) == 1
    store.update("count", (1, 2, 3), None)
    store.commit()
    assert contents(store) == [("count", (1, 2, 3))]


def test_an_update_if_new_to_equal_values_changes_nothing():
    store = store_of(("count", 0), ("place", 1, [2, True]))
    store.update("count", (0,), None, if_new=True)
    store.update("count", (0.0,), (), if_new=True)
    store.update("place", (1, (2, True)), None, if_new=True)
    assert not store.changing
    assert store.commit() is NO_CHANGES


def test_an_update_if_new_to_other_values_or_annotations_is_a_change():
    for new, annotations in (((1,), None), ((False,), None), ((0, 0), None), ((0,), ("mark",))):
        store = store_of(("count", 0))
        store.update("count", new, annotations, if_new=True)
        assert [change[1].values for change in store.commit().changed] == [new]


def test_a_property_defined_and_removed_in_one_step_was_never_there():
    store = store_of()
    store.define("tmp", (1,), None)
    store.update("tmp", (2,), None)
    store.remove("tmp", ())
    assert store.commit() == NO_CHANGES
    assert not store.has("tmp")


def test_removed_and_defined_again_is_a_removal_and_an_addition():
    store = store_of(("p", 1))
    store.remove("p", ())
    store.define("p", (1,), None)
    changes = store.commit()
    assert (changes.changed, len(changes.added), len(changes.removed)) == ((), 1, 1)
    assert changes.added[0].key != changes.removed[0].key


def test_an_update_and_removal_in_one_step_reports_the_observed_value_or_is_rolled_back_to_it():
    store = store_of(("p", 1))
    for end in (store.roll_back, store.commit):
        store.update("p", (2,), None)
        store.remove("p", ())
        changes = end()
        assert contents(store) == ([("p", (1,))] if end == store.roll_back else [])
    assert [old.values for old in changes.removed] == [(1,)]


def test_properties_may_share_a_name_and_the_oldest_is_the_first():
    store = store_of(("p", 1), ("p", 2), ("p", 1))
    assert store.first("p").values == (1,)
    store.update("p", (9,), None)
    store.remove("p", (1,))
    store.commit()
    assert contents(store) == [("p", (9,)), ("p", (2,))]


def test_templates_have_wildcards_and_the_right_length():
    store = store_of(("p", 1, "a"), ("p", 2, "b"), ("p", True))
    assert store.first("p", (None, "b")).values == (2, "b")
    assert store.first("p", (None,)).values == (True,)
    assert store.has("p", (2, None))
    assert not store.has("p", (1,)), "1 is not true"
    assert not store.has("p", (1, "a", None))
    assert not store.has("q")


def test_roll_back_undoes_additions_updates_and_removals_and_keeps_the_order():
    store = store_of(("p", 1), ("p", 2), ("p", 3), ("q", 4))
    store.remove("p", (1,))
    store.update("p", (20,), None)
    store.remove("q", ())
    store.define("p", (5,), None)
    store.define("r", (6,), None)
    store.roll_back()
    assert store.commit() is NO_CHANGES
    assert contents(store) == [("p", (1,)), ("p", (2,)), ("p", (3,)), ("q", (4,))]
    assert store.first("p").values == (1,)
    assert not store.has("r")


def test_observers_of_a_step_in_progress_see_what_was_committed():
    store = store_of(("p", 1), ("q", 2))
    store.update("p", (9,), None)
    store.remove("q", ())
    store.define("r", (3,), None)
    assert contents(store) == [("p", (1,)), ("q", (2,))]
    assert store.first("p").values == (9,)


def test_values_are_copied_so_later_changes_have_no_effect():
    trace = [1]
    store = store_of(("trace", trace))
    trace.append(2)
    assert store.first("trace").values == ([1],)


def test_annotations_stay_until_they_are_replaced():
    store = PropertyStore()
    store.define("p", (1,), ("a",))
    store.update("p", (2,), None)
    assert store.first("p").annotations == ("a",)
    store.update("p", (3,), ("b",))
    assert store.first("p").annotations == ("b",)
    changes = store.commit()
    assert changes.added[0].annotations == ("b",)


def test_an_unknown_property_is_explained():
    store = store_of(("count", 0), ("level", 1))
    with pytest.raises(
        UnknownProperty, match=r"unknown observable property `cuont` \(it has count, level\); did you mean"
    ):
        store.update("cuont", (1,), None)
    with pytest.raises(UnknownProperty, match="it has none"):
        PropertyStore().first("p")
    with pytest.raises(UnknownProperty, match=r"count has the values \(5,\)"):
        store.remove("count", (5,))


def test_the_name_of_a_property_begins_with_a_lower_case_letter():
    for wrong in ("Count", "", "1st", "_x"):
        with pytest.raises(InvalidArtifact, match="lower-case"):
            PropertyStore().define(wrong, (), None)


class Rooms(Artifact):
    def init(self):
        self.define_property("room", "kitchen", "dirty")
        self.define_property("room", "hall", "dirty")
        self.define_property("pose", 1, 2)

    @operation
    def clean(self, room: str):
        self.update_property("room", room, "clean", where=(room, None))

    @operation
    def clean_value(self, room: str):
        self.update_value("room", 1, "clean", where=(room, None))

    @operation
    def turn(self, index: int, value: float):
        self.update_value("pose", index, value)

    @operation
    def grow(self, *values: object):
        self.update_property("pose", *values)

    @operation
    def note(self, *annotations: object):
        self.annotate_property("room", *annotations, where=("hall", None))

    @operation
    def note_and_clean(self, *annotations: object):
        self.annotate_property("room", *annotations)
        self.update_value("room", 1, "clean")

    @operation
    def dirty(self, rooms: Out):
        rooms.set([p.values[0] for p in self.find_properties("room", None, "dirty")])


pytestmark = pytest.mark.makes(it=Rooms)


async def test_the_property_to_update_is_found_by_its_values(stage, it, watcher):
    names = Out()
    assert stage.call(it, "clean", "hall").ok
    assert stage.call(it, "dirty", names).ok
    assert names.value == ["kitchen"]
    assert stage.call(it, "clean_value", "kitchen").ok
    assert watcher.notes == [
        "-room('hall','dirty') +room('hall','clean')",
        "-room('kitchen','dirty') +room('kitchen','clean')",
    ]
    call = stage.call(it, "clean", "cellar")
    assert "no property room has the values ('cellar', None)" in call.outcome.message


async def test_one_of_several_values_is_updated(stage, it, watcher):
    assert stage.call(it, "turn", 1, 7.5).ok
    assert watcher.notes == ["-pose(1,2) +pose(1,7.5)"]
    assert "IndexError" in stage.call(it, "turn", 2, 7.5).outcome.message


async def test_more_values_and_fewer_values_than_before(stage, it, watcher):
    for values in [(1, 2, 3), (1,), ()]:
        assert stage.call(it, "grow", *values).ok
    assert watcher.notes == ["-pose(1,2) +pose(1,2,3)", "-pose(1,2,3) +pose(1)", "-pose(1) +pose"]


async def test_annotations_are_added_once_and_a_later_update_is_not_lost(stage, it):
    watcher = stage.watch(it)
    seen = Structure("seen", (1,))
    assert stage.call(it, "note", seen, Atom("big")).ok
    assert stage.call(it, "note", Atom("big")).ok
    assert stage.call(it, "note_and_clean", seen).ok
    changes = [change for each in watcher.observations for change in each.changed]
    assert [(new.values, new.annotations) for _, new in changes] == [
        (("hall", "dirty"), (seen, "big")),
        (("hall", "dirty"), (seen, "big")),
        (("kitchen", "clean"), (seen,)),
    ]


async def test_properties_of_every_artifact_can_be_read_without_focus(stage, it):
    out = Out()
    assert stage.call(it, "observeProperty", "pose", out).ok
    assert stage.call(it, "turn", 1, 7.5).ok
    assert out.value == Structure("pose", (1, 2)), "it is the value of that moment"
    call = stage.call(it, "observeProperty", "posse", Out())
    assert (call.outcome.message, call.reason) == (
        "Property not found posse",
        Structure("unknown_property", ("posse",)),
    )
    assert "observeProperty" not in stage.call(it, "fly").outcome.message, "lists show what is its own"


FIRST_VALUES = (*range(30), 2.0, 2.5, True, False, "a", Atom("a"), [1], Structure("p", (1,)), float("nan"))


def test_many_properties_are_found_as_few_are():
    random, store = Random(7), PropertyStore()

    def anything():
        return random.choice(FIRST_VALUES)

    def step():
        for _ in range(random.randrange(4)):
            here = store.all("cell")
            what = random.randrange(5)
            if what < 2 or not here:
                store.define("cell", (anything(), anything())[: random.randrange(3)], None)
            elif what == 2:
                store.remove("cell", random.choice(here).values)
            elif what == 3:
                store.update("cell", (anything(), 1), None, where=random.choice(here).values)
            else:
                store.update("cell", (anything(), 2), None)

    for _ in range(150):
        try:
            step()
        except UnknownProperty:
            store.roll_back()  # values that equal nothing, such as NaN
        else:
            (store.commit if random.randrange(4) else store.roll_back)()
        for first in FIRST_VALUES:
            for template in ((first,), (first, 1), (None, first)):
                held = store._by_name.get("cell", {}).values()
                wanted = [each for each in held if properties.fits(template, each.values)]
                assert list(map(id, store.all("cell", template))) == list(map(id, wanted))
                assert store.has("cell", template) == bool(wanted)
    assert len(store.all("cell")) > 20


def test_one_of_many_properties_is_found_without_a_search(monkeypatch):
    store = store_of(*(("cell", number, 0) for number in range(1000)))
    looks = []
    fits = properties.fits
    monkeypatch.setattr(
        properties, "fits", lambda template, values: looks.append(values) or fits(template, values)
    )
    for number in range(1000):
        store.update("cell", (number, 1), None, where=(number, 0))
        assert store.first("cell", (number, None)).values == (number, 1)
        store.remove("cell", (number, None))
    assert len(looks) < 5000
