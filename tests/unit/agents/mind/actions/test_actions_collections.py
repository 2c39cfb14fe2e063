import pytest
from fake_context import FakeContext, term

from jacaros.agents.mind.actions.internal_action import STANDARD, WrongArguments
from jacaros.agents.terms.collections import MapValue, QueueValue, SetValue
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import Term, Var


def created(mind: FakeContext, kind: str, *options: object) -> Term:
    variable = Var("C")
    assert mind.succeeds(f".{kind}.create", variable, *options)
    return variable


@pytest.mark.parametrize("kind", ["set", "map", "queue"])
def test_only_an_unbound_variable_can_become_a_new_collection(mind, kind):
    collection = created(mind, kind)
    assert not mind.succeeds(f".{kind}.create", collection)
    assert not mind.succeeds(f".{kind}.create", 1)


# sets


def test_a_set_holds_each_element_once_in_order_and_its_copy_is_independent(mind):
    collection = created(mind, "set")
    for item in ("b", "a", "b"):
        assert mind.succeeds(".set.add", collection, item)
    assert text(collection) == "{a,b}"
    assert mind.result(".set.to_list", collection) == "[a,b]"
    assert mind.succeeds(".set.remove", collection, "b")
    assert mind.succeeds(".set.remove", collection, "z")
    assert text(collection) == "{a}"
    first, copy = created(mind, "set"), Var("D")
    mind.succeeds(".set.add", first, 1)
    assert mind.succeeds(".set.copy", first, copy)
    assert mind.succeeds(".set.clear", first)
    assert (text(first), text(copy)) == ("{}", "{1}")


@pytest.mark.parametrize("action", [".set.add_all", ".set.union"])
def test_a_set_takes_all_elements_of_lists_sets_and_queues(mind, action):
    collection, other, waiting = created(mind, "set"), created(mind, "set"), created(mind, "queue")
    mind.succeeds(".set.add", other, "z")
    mind.succeeds(".queue.add", waiting, "q")
    for items in (["c", "b", "c"], other, waiting, collection):
        assert mind.succeeds(action, collection, items)
    assert text(collection) == "{b,c,q,z}"


def test_set_operations_change_the_first_set_and_equal_sets_unify(mind):
    first = created(mind, "set")
    mind.succeeds(".set.add_all", first, [1, 2, 3])
    assert mind.succeeds(".set.intersection", first, [2, 3, 9])
    assert text(first) == "{2,3}"
    assert mind.succeeds(".set.difference", first, [2, 9])
    assert text(first) == "{3}"
    assert mind.succeeds(".set.difference", first, first)
    assert text(first) == "{}"
    first, second = created(mind, "set"), created(mind, "set")
    mind.succeeds(".set.add_all", first, [1, 2])
    mind.succeeds(".set.add_all", second, [2, 1])
    assert mind.unify(first, second)
    mind.succeeds(".set.add", second, 3)
    assert not mind.unify(first, second)


# maps


def test_a_map_keeps_one_value_for_each_key_and_has_defaults(mind):
    collection = created(mind, "map")
    for key, value in (("b", 1), ("a", 2), ("b", [3])):
        assert mind.succeeds(".map.put", collection, key, value)
    assert text(collection) == "{a->2,b->[3]}"
    assert mind.result(".map.get", collection, "b") == "[3]"
    assert not mind.succeeds(".map.get", collection, "b", 1)
    assert not mind.succeeds(".map.get", collection, "z", Var("V"))
    collection, value = created(mind, "map"), Var("V")
    assert mind.instances(".map.get", collection, "z", value, "none", of=value) == ["none"]


def test_keys_and_values_come_in_order_and_are_removed_together(mind):
    collection, item = created(mind, "map"), Var("X")
    for key, value in (("b", 1), ("a", 2), ("c", 1)):
        mind.succeeds(".map.put", collection, key, value)
    assert mind.instances(".map.key", collection, item, of=item) == ["a", "b", "c"]
    assert mind.instances(".map.value", collection, item, of=item) == ["2", "1", "1"]
    assert mind.succeeds(".map.key", collection, "b")
    assert not mind.succeeds(".map.value", collection, 9)
    collection = created(mind, "map")
    mind.succeeds(".map.put", collection, "a", 1)
    mind.succeeds(".map.put", collection, "b", 2)
    assert mind.result(".map.remove", collection, "a") == "1"
    assert not mind.succeeds(".map.remove", collection, "a", Var("V"))
    assert mind.succeeds(".map.remove", collection, "b")
    assert text(collection) == "{}"


def test_a_copied_map_is_independent(mind):
    first, copy = created(mind, "map"), Var("D")
    mind.succeeds(".map.put", first, "a", 1)
    assert mind.succeeds(".map.copy", first, copy)
    assert mind.succeeds(".map.clear", first)
    assert (text(first), text(copy)) == ("{}", "{a->1}")


# queues


def test_a_queue_gives_its_elements_in_the_order_they_came(mind):
    collection = created(mind, "queue")
    assert mind.succeeds(".queue.add_all", collection, ["c", "a"])
    assert mind.succeeds(".queue.add", collection, "b")
    assert mind.result(".queue.head", collection) == "c"
    assert mind.result(".queue.to_list", collection) == "[c,a,b]"
    assert [mind.result(".queue.remove", collection) for _ in range(3)] == ["c", "a", "b"]
    collection = created(mind, "queue")
    assert not mind.succeeds(".queue.head", collection, Var("X"))
    assert not mind.succeeds(".queue.remove", collection, Var("X"))


def test_a_priority_queue_gives_its_smallest_element_first_and_its_copy_is_independent(mind):
    collection = created(mind, "queue", "priority")
    mind.succeeds(".queue.add_all", collection, [("t", 5, "e"), ("t", 1, "a"), ("t", 3, "c")])
    assert text(collection) == "[t(1,a),t(3,c),t(5,e)]"
    assert mind.result(".queue.head", collection) == "t(1,a)"
    assert [mind.result(".queue.remove", collection) for _ in range(3)] == ["t(1,a)", "t(3,c)", "t(5,e)"]
    first, copy = created(mind, "queue", "priority"), Var("D")
    mind.succeeds(".queue.add_all", first, [2, 1])
    assert mind.succeeds(".queue.copy", first, copy)
    assert mind.succeeds(".queue.clear", first)
    assert mind.succeeds(".queue.add", copy, 0)
    assert (text(first), text(copy)) == ("[]", "[0,1,2]")


# all of them

CHANGES = [
    (".set.add", (1,), "{1}"),
    (".set.add_all", ([1],), "{1}"),
    (".set.union", ([1],), "{1}"),
    (".set.intersection", ([1],), "{}"),
    (".set.difference", ([1],), "{}"),
    (".set.remove", (1,), "{}"),
    (".set.to_list", (Var("L"),), "{}"),
    (".set.copy", (Var("D"),), "{}"),
    (".set.clear", (), "{}"),
    (".map.put", ("k", 1), "{k->1}"),
    (".map.get", ("k", Var("V"), 0), "{}"),
    (".map.remove", ("k",), "{}"),
    (".map.key", (Var("K"),), "{}"),
    (".map.value", (Var("V"),), "{}"),
    (".map.copy", (Var("D"),), "{}"),
    (".map.clear", (), "{}"),
    (".queue.add", (1,), "[1]"),
    (".queue.add_all", ([1],), "[1]"),
    (".queue.head", (Var("X"),), "[]"),
    (".queue.remove", (Var("X"),), "[]"),
    (".queue.to_list", (Var("L"),), "[]"),
    (".queue.copy", (Var("D"),), "[]"),
    (".queue.clear", (), "[]"),
]


def test_every_action_on_collections_is_tested_here():
    actions = {
        name for name in STANDARD if name.split(".")[1] in ("set", "map", "queue") and name.count(".") == 2
    }
    assert actions - {name for name, _, _ in CHANGES} == {".set.create", ".map.create", ".queue.create"}


@pytest.mark.parametrize(("action", "arguments", "made"), CHANGES)
def test_an_unbound_variable_becomes_a_collection(mind, action, arguments, made):
    variable = Var("C")
    mind.succeeds(action, variable, *arguments)
    assert text(variable) == made


@pytest.mark.parametrize(("action", "arguments", "made"), CHANGES)
@pytest.mark.parametrize("other", [lambda: 1.0, lambda: term(["a"]), SetValue, MapValue, QueueValue])
def test_any_other_first_argument_is_wrong(mind, action, arguments, made, other):
    value = other()
    if action.startswith(f".{type(value).__name__.removesuffix('Value').lower()}."):
        return
    with pytest.raises(WrongArguments, match="the first argument must be a"):
        mind.succeeds(action, value, *arguments)


@pytest.mark.parametrize(
    "action", [".set.add_all", ".set.union", ".set.intersection", ".set.difference", ".queue.add_all"]
)
def test_only_lists_sets_and_queues_have_elements(mind, action):
    with pytest.raises(WrongArguments, match="the second argument"):
        mind.succeeds(action, Var("C"), "a")
