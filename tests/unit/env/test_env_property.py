"""The store of observable properties: names, templates, commits, roll-backs."""

import pytest

from jacaros.env import InvalidArtifact, UnknownProperty
from jacaros.env.property import NO_CHANGES, PropertyStore


def contents(store):
    return [(p.name, p.values) for p in store.committed()]


def store_of(*properties):
    store = PropertyStore()
    for name, *values in properties:
        store.define(name, tuple(values), None)
    store.commit()
    return store


def test_several_updates_in_one_step_are_one_change():
    store = store_of(("count", 0))
    for number in (1, 2, 3):
        store.update("count", (number,), None)
    changes = store.commit()
    assert [(old.values, new.values) for old, new in changes.changed] == [((0,), (3,))]
    assert (changes.added, changes.removed) == ((), ())
    assert store.commit() is NO_CHANGES


def test_an_update_to_an_equal_value_is_a_change():
    store = store_of(("count", 0))
    store.update("count", (0,), None)
    assert len(store.commit().changed) == 1


def test_an_update_if_new_to_equal_values_is_no_change():
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


def test_a_step_that_comes_back_to_the_old_value_has_changed_it_all_the_same():
    store = store_of(("count", 0))
    store.update("count", (1,), None, if_new=True)
    store.update("count", (0,), None, if_new=True)
    assert len(store.commit().changed) == 1


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


def test_updated_and_removed_in_one_step_tells_the_value_that_observers_know():
    store = store_of(("p", 1))
    store.update("p", (2,), None)
    store.remove("p", ())
    assert [old.values for old in store.commit().removed] == [(1,)]


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


def test_the_number_of_values_may_change():
    store = store_of(("p", 1))
    store.update("p", (1, 2, 3), None)
    store.commit()
    assert contents(store) == [("p", (1, 2, 3))]


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


def test_a_property_updated_and_removed_is_rolled_back_to_its_old_values():
    store = store_of(("p", 1))
    store.update("p", (2,), None)
    store.remove("p", ())
    store.roll_back()
    assert contents(store) == [("p", (1,))]


def test_observers_of_a_step_in_progress_see_what_was_committed():
    store = store_of(("p", 1), ("q", 2))
    store.update("p", (9,), None)
    store.remove("q", ())
    store.define("r", (3,), None)
    assert contents(store) == [("p", (1,)), ("q", (2,))]
    assert store.first("p").values == (9,)


def test_values_are_copied_so_that_nobody_changes_them_behind_the_back():
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
        UnknownProperty, match=r"no observable property cuont \(it has count, level\); did you mean"
    ):
        store.update("cuont", (1,), None)
    with pytest.raises(UnknownProperty, match="it has none"):
        PropertyStore().first("p")
    with pytest.raises(UnknownProperty, match=r"count with values like \(5,\)"):
        store.remove("count", (5,))


def test_the_name_of_a_property_begins_with_a_lower_case_letter():
    for wrong in ("Count", "", "1st", "_x"):
        with pytest.raises(InvalidArtifact, match="lower-case"):
            PropertyStore().define(wrong, (), None)
