import pytest
from fake_context import FakeContext, term

from jacaros.agents.mind.actions.internal_action import ActionError, WrongArguments
from jacaros.agents.terms.collections import MapValue, QueueValue, SetValue
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import Annotated, String, Term, Var, atom, make_list


def queue(*items: object) -> QueueValue:
    made = QueueValue()
    for item in items:
        made.add(term(item))
    return made


def set_of(*items: object) -> SetValue:
    return SetValue(dict.fromkeys(map(term, items)))


def annotated(name: str, *annotations: str) -> Term:
    return Annotated(atom(name), tuple(map(atom, annotations)))


# .length and .empty


@pytest.mark.parametrize(
    ("collection", "size"),
    [
        ([], "0"),
        (["a", ["b", "c"]], "2"),
        (String("wörd"), "4"),
        (String(""), "0"),
        (set_of(1, 2, 2), "2"),
        (MapValue({atom("k"): 1.0}), "1"),
        (queue(1, 1), "2"),
        (make_list([1.0, 2.0], Var("T")), "2"),
    ],
)
def test_length_counts_elements_or_characters(mind, collection, size):
    assert mind.result(".length", collection) == size


def test_length_and_delete_fail_for_another_result(mind):
    assert not mind.succeeds(".length", ["a"], 2)
    assert not mind.succeeds(".length", "a", Var("N"))
    assert not mind.succeeds(".length", Var("L"), Var("N"))
    pattern = Var("X")
    assert mind.result(".delete", ("f", pattern), [("f", 1), ("f", 2)]) == "[f(2)]"
    assert text(pattern) == "X"
    assert not mind.succeeds(".delete", "a", ["a", "b"], [])


@pytest.mark.parametrize("collection", [[], String(""), set_of(), queue(), MapValue()])
def test_empty_holds_for_empty_collections(mind, collection):
    assert mind.succeeds(".empty", collection)


@pytest.mark.parametrize("collection", [["a"], String("a"), set_of(1), "a", 0, Var("X")])
def test_empty_fails_for_other_terms(mind, collection):
    assert not mind.succeeds(".empty", collection)


# .member


def test_member_gives_the_elements_that_unify_in_turn(mind):
    item = Var("X")
    assert mind.instances(".member", item, ["c", "a", "b", "a"], of=item) == ["c", "a", "b", "a"]
    assert mind.instances(".member", item, [], of=item) == []
    collection = [("b", 1), ("c", 2), ("b", 3), ("b", 4, 5)]
    assert mind.instances(".member", ("b", item), collection, of=item) == ["1", "3"]
    assert mind.instances(".member", ("p", item, "z"), [("p", 1, "a"), ("p", 2, "z")], of=item) == ["2"]


def test_member_requires_annotations_and_reads_every_kind_of_collection(mind):
    assert mind.succeeds(".member", "p", [annotated("p", "a")])
    assert not mind.succeeds(".member", annotated("p", "a"), ["p"])
    item = Var("X")
    assert mind.instances(".member", item, set_of("b", "a"), of=item) == ["a", "b"]
    assert mind.instances(".member", item, queue("b", "a", "b"), of=item) == ["b", "a", "b"]
    assert mind.instances(".member", "b", set_of("b"), of="yes") == ["yes"]
    assert mind.instances(".member", "b", queue("b", "b"), of="yes") == ["yes"]
    assert not mind.succeeds(".member", "z", set_of("b"))
    assert not mind.succeeds(".member", "p", set_of(annotated("p", "a")))


@pytest.mark.parametrize("collection", ["a", 1, String("abc"), Var("L"), MapValue()])
def test_member_needs_a_collection(mind, collection):
    with pytest.raises(WrongArguments, match="must be a list, a set or a queue"):
        mind.succeeds(".member", Var("X"), collection)


# .nth


def test_nth_counts_from_zero_and_gives_all_positions_of_an_element(mind):
    assert mind.result(".nth", 0, ["a", "b", "c"]) == "a"
    assert mind.result(".nth", 2.9, ["a", "b", "c"]) == "c"
    assert not mind.succeeds(".nth", 0, ["a"], "b")
    index, item = Var("I"), Var("X")
    assert mind.instances(".nth", index, ["x", "y", "x"], "x", of=index) == ["0", "2"]
    assert mind.instances(".nth", index, ["x", "y"], item, of=["i", index, item]) == ["[i,0,x]", "[i,1,y]"]
    assert mind.instances(".nth", index, ["x"], "z", of=index) == []
    both = Var("X")
    assert mind.instances(".nth", both, ["a", 1, 5], both, of=both) == ["1"]
    assert mind.result(".nth", 1, String("aéb")) == '"é"'


@pytest.mark.parametrize("index", [-1, 3, 5])
def test_nth_without_such_a_position_is_an_error(mind, index):
    with pytest.raises(ActionError, match=f"position {index} is outside the 3 elements"):
        mind.succeeds(".nth", index, ["a", "b", "c"], Var("X"))


@pytest.mark.parametrize("arguments", [("a", ["a"]), (0, "a"), (Var("I"), 1)])
def test_nth_needs_a_number_and_a_list(mind, arguments):
    with pytest.raises(WrongArguments):
        mind.succeeds(".nth", *arguments, Var("X"))


# .concat


def test_concat_joins_lists_and_keeps_the_open_tail_of_the_last(mind):
    assert mind.result(".concat", ["a"], [], ["b", "c"], ["d"]) == "[a,b,c,d]"
    assert mind.succeeds(".concat", ["a"], ["b"], ["a", "b"])
    assert not mind.succeeds(".concat", ["a"], ["b"], ["b", "a"])
    assert mind.result(".concat", ["a"], make_list([atom("b")], Var("T"))) == "[a,b|T]"
    with pytest.raises(ActionError, match="open tail"):
        mind.succeeds(".concat", make_list([atom("b")], Var("T")), ["a"], Var("R"))


def test_concat_joins_strings_with_any_terms_and_takes_the_quotes_off_atoms(mind):
    assert mind.result(".concat", String("a b"), 1, "a", ("f", String("s"))) == '"a b1af("s")"'
    assert mind.result(".concat", "x", ["a"]) == '"x[a]"'
    assert mind.succeeds(".concat", String("a"), String("b"), "ab")
    assert not mind.succeeds(".concat", String("a"), String("b"), String("a"))
    assert mind.result(".concat", "'x y'", "z", ("f", "'q'")) == "\"x yzf('q')\""


def test_concat_and_delete_refuse_other_kinds(mind):
    with pytest.raises(WrongArguments, match="argument 2"):
        mind.succeeds(".concat", ["a"], "b", Var("R"))
    with pytest.raises(ActionError, match="last argument"):
        mind.succeeds(".concat", ["a"], ["b"], String("ab"))
    with pytest.raises(WrongArguments):
        mind.succeeds(".delete", "a", "b", Var("R"))
    with pytest.raises(WrongArguments):
        mind.succeeds(".delete", 1, "b", Var("R"))
    with pytest.raises(ActionError, match="invalid regular expression"):
        mind.succeeds(".delete", String("("), String("b"), Var("R"))


# .delete


@pytest.mark.parametrize(
    ("arguments", "rest"),
    [
        (("a", ["a", "b", "a", "c"]), "[b,c]"),
        ((("f", Var("_")), [("f", 1), ("g", 2), ("f", 3), ("f", 1)]), "[g(2),f(3)]"),
        (("z", ["a"]), "[a]"),
        ((3, ["a", "b", "a", "c", "a"]), "[a,b,a,a]"),
        ((9, ["a"]), "[a]"),
        ((1, 3, ["a", "b", "c", "a"]), "[a,a]"),
        ((0, 4, ["a", "b", "c", "d", "e"]), "[e]"),
        ((0, String("banana")), '"anana"'),
        ((2, 4, String("abcdef")), '"abef"'),
        ((6, String("banana")), '"banana"'),
        ((2, 9, String("abc")), '"abc"'),
        ((String("a"), String("banana")), '"bnn"'),
        ((String("[0-9]+"), String("a1b22")), '"ab"'),
        ((String("a"), ["a", "b"]), '"[,b]"'),
        ((Var("Any"), ["a", 1, "a"]), "[1]"),
    ],
)
def test_delete_removes_elements(mind, arguments, rest):
    assert mind.result(".delete", *arguments) == rest


# .reverse .sort .shuffle


def test_reverse_turns_lists_and_strings_around(mind):
    assert mind.result(".reverse", [1, [2, 3], 4]) == "[4,[2,3],1]"
    assert mind.result(".reverse", []) == "[]"
    assert mind.result(".reverse", String("abc")) == '"cba"'
    assert mind.result(".reverse", ("f", 1)) == '")1(f"'
    assert mind.result(".reverse", make_list([1.0, 2.0], Var("T"))) == "[2,1|T]"
    assert not mind.succeeds(".reverse", [1, 2], [1, 2])


@pytest.mark.parametrize("arguments", [([1], String("x")), (String("ab"), [1]), (String("ab"), "ba")])
def test_reverse_refuses_a_result_of_another_kind(mind, arguments):
    with pytest.raises(WrongArguments):
        mind.succeeds(".reverse", *arguments)


def test_sort_uses_the_standard_order_and_keeps_duplicates(mind):
    mixed = [Var("X"), "b", ["a"], String("s"), 2, "a", ("a", 1), 2, -1]
    assert mind.result(".sort", mixed) == '[-1,2,2,"s",[a],a,a(1),b,X]'
    assert mind.succeeds(".sort", [3, 2], [2, 3])
    assert not mind.succeeds(".sort", [3, 2], [3, 2])
    with pytest.raises(WrongArguments):
        mind.succeeds(".sort", String("ba"), Var("R"))


def test_shuffle_keeps_the_elements_and_follows_the_seed(mind):
    items = list(range(20))
    first = mind.result(".shuffle", items)
    assert first == FakeContext().result(".shuffle", items) != mind.result(".shuffle", items)
    shuffled = Var("S")
    assert mind.succeeds(".shuffle", items, shuffled)
    assert mind.result(".sort", shuffled) == text(term(items))
    with pytest.raises(WrongArguments):
        mind.succeeds(".shuffle", "a", Var("R"))


# .max .min


def test_max_and_min_use_the_standard_order_of_lists_and_answers(mind):
    assert mind.result(".max", ["b", "c", 10, "g", ("f", 10), 5, ("f", 4)]) == "g"
    assert mind.result(".min", ["b", [3, 4], 5, [3], ("f", 4)]) == "5"
    assert mind.succeeds(".max", [3, 2, 5], 5)
    assert not mind.succeeds(".max", [3, 2, 5], 2)
    assert not mind.succeeds(".max", [], Var("X"))
    assert not mind.succeeds(".min", [], Var("X"))
    value = Var("V")
    formula = ("b", value)
    mind.facts = [("b", 2), ("b", 7), ("b", 5), ("c", 9)]
    assert mind.result(".max", value, formula) == "7"
    assert mind.result(".min", ("p", value), formula) == "p(2)"
    assert mind.succeeds(".max", value, formula, 7)
    assert not mind.succeeds(".max", value, ("d", value), Var("X"))
    assert value.ref is None


@pytest.mark.parametrize("action", [".max", ".min"])
def test_max_and_min_need_a_list(mind, action):
    with pytest.raises(WrongArguments, match=f"first argument of {action} must be a list, not notalist"):
        mind.succeeds(action, "notalist", Var("X"))


# .range


def test_range_counts_with_both_ends_and_tests_a_number(mind):
    item = Var("X")
    assert mind.instances(".range", item, 1, 4, of=item) == ["1", "2", "3", "4"]
    assert mind.instances(".range", item, 1, 6, 2, of=item) == ["1", "3", "5"]
    assert mind.instances(".range", item, 3, 1, -1, of=item) == ["3", "2", "1"]
    assert mind.instances(".range", item, 3, 1, of=item) == []
    assert mind.instances(".range", 3, 1, 5, of="in") == ["in"]
    assert not mind.succeeds(".range", 6, 1, 5)
    assert mind.succeeds(".range", 2, 1, 5, 2)


@pytest.mark.parametrize(
    "arguments",
    [("a", 1, 2), (Var("X"), "a", 2), (Var("X"), 1, Var("E")), (Var("X"), 1, 2, "b"), (Var("X"), 1, 2, 0)],
)
def test_range_needs_numbers(mind, arguments):
    with pytest.raises(WrongArguments):
        mind.succeeds(".range", *arguments)


# .union .intersection .difference


def test_sets_made_of_lists_are_sorted_and_hold_each_element_once(mind):
    assert mind.result(".union", ["a", "b", "a", "c"], ["f", "e", "a"]) == "[a,b,c,e,f]"
    assert mind.result(".intersection", ["c", "b", "a", "c"], ["c", "a", "x", "a"]) == "[a,c]"
    assert mind.result(".difference", ["a", "b", "a", "c"], ["f", "a", "c"]) == "[b]"
    assert mind.result(".difference", [], ["a"]) == "[]"
    assert not mind.succeeds(".union", ["a"], ["b"], ["a"])
    assert mind.result(".union", [annotated("p", "a")], ["p"]) == "[p,p[a]]"
    assert mind.result(".intersection", [annotated("p", "a")], ["p"]) == "[]"
    long = list(range(5000))
    assert mind.result(".union", [long], [list(long)]) == text(term([long]))
    assert mind.result(".difference", [long], [list(long)]) == "[]"


@pytest.mark.parametrize("action", [".union", ".intersection", ".difference"])
@pytest.mark.parametrize("arguments", [("a", [], Var("R")), ([], "a", Var("R")), ([], [], "a")])
def test_sets_made_of_lists_need_lists(mind, action, arguments):
    with pytest.raises(WrongArguments):
        mind.succeeds(action, *arguments)


# .sublist .prefix .suffix


def test_sublist_gives_all_contiguous_parts_and_finds_one(mind):
    part = Var("S")
    expected = ["[a,b,c]", "[a,b]", "[a]", "[b,c]", "[b]", "[c]", "[]"]
    assert mind.instances(".sublist", part, ["a", "b", "c"], of=part) == expected
    assert mind.instances(".sublist", part, [], of=part) == ["[]"]
    item = Var("X")
    assert mind.instances(".sublist", ["a", item], ["a", 1, "a", 2], of=item) == ["1", "2"]
    assert mind.instances(".sublist", [], ["a"], of="yes") == ["yes"]
    assert not mind.succeeds(".sublist", ["a", "c"], ["a", "b", "c"])
    rest = Var("T")
    assert mind.instances(".sublist", make_list([atom("b")], rest), ["a", "b", "c"], of=rest) == ["[c]", "[]"]


def test_prefix_and_suffix_of_lists_and_strings_give_longer_parts_first(mind):
    part = Var("P")
    assert mind.instances(".prefix", part, ["a", "b"], of=part) == ["[a,b]", "[a]", "[]"]
    assert mind.instances(".suffix", part, ["a", "b"], of=part) == ["[a,b]", "[b]", "[]"]
    assert mind.succeeds(".prefix", ["a"], ["a", "b"])
    assert not mind.succeeds(".prefix", ["b"], ["a", "b"])
    assert mind.succeeds(".suffix", ["b"], ["a", "b"])
    assert not mind.succeeds(".suffix", ["a"], ["a", "b"])
    assert mind.instances(".prefix", part, String("ab"), of=part) == ['"ab"', '"a"', '""']
    assert mind.instances(".suffix", part, String("ab"), of=part) == ['"ab"', '"b"', '""']
    assert mind.succeeds(".prefix", String("ab"), String("abc"))
    assert not mind.succeeds(".suffix", String("ab"), String("abc"))


@pytest.mark.parametrize("action", [".sublist", ".prefix", ".suffix"])
@pytest.mark.parametrize(
    "arguments", [("a", ["a"]), (["a"], "a"), (String("a"), ["a"]), (Var("P"), Var("L"))]
)
def test_parts_of_lists_need_lists(mind, action, arguments):
    with pytest.raises(WrongArguments):
        mind.succeeds(action, *arguments)
