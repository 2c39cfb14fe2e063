import pytest

from jacaros.agents.mind.actions.internal_action import ActionError, WrongArguments
from jacaros.agents.mind.actions.terms import replace_all
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import String, Var, structure

# .substring


def test_substring_tests_for_a_part_and_a_given_place(mind):
    assert mind.succeeds(".substring", String("b"), String("abc"))
    assert not mind.succeeds(".substring", String("x"), String("abc"))
    assert mind.succeeds(".substring", ("a", 10), ("b", "t1", ("a", 10)))
    assert mind.succeeds(".substring", String(""), String(""))
    assert mind.succeeds(".substring", String("a"), String("bab"), 1)
    assert not mind.succeeds(".substring", String("a"), String("bab"), 0)
    assert mind.succeeds(".substring", String("an"), String("banana"), 3, 4)


def test_substring_gives_the_place_of_each_occurrence_and_cuts_out_a_part(mind):
    first, last = Var("I"), Var("J")
    assert mind.instances(".substring", String("a"), String("abbacca"), first, of=first) == ["0", "3", "6"]
    assert mind.instances(".substring", ("a", 10), ("b", "t1", ("a", 10)), first, of=first) == ["5"]
    assert mind.instances(
        ".substring", String("an"), String("banana"), first, last, of=("p", first, last)
    ) == ["p(1,2)", "p(3,4)"]
    assert mind.instances(".substring", String("aa"), String("aaa"), first, of=first) == ["0", "1"]
    assert mind.instances(".substring", String("x"), String("abc"), first, of=first) == []
    assert mind.instances(".substring", String(""), String("ab"), first, of=first) == ["0", "1"]
    part = Var("X")
    assert mind.instances(".substring", part, String("hello world"), 6, of=part) == ['"world"']
    assert mind.instances(".substring", part, String("hello world"), 0, 5, of=part) == ['"hello"']
    assert mind.instances(".substring", part, ("a", 10, 20), 5, 7, of=part) == ['"20"']
    assert mind.instances(".substring", part, String("ab"), 2, of=part) == ['""']
    assert mind.instances(".substring", String("hello"), part, 1, 3, of=part) == ['"el"']


@pytest.mark.parametrize("bounds", [(-1,), (4,), (2, 1), (0, 9)])
def test_substring_refuses_positions_outside_of_the_text(mind, bounds):
    with pytest.raises(ActionError, match="outside the 3 characters"):
        mind.succeeds(".substring", Var("X"), String("abc"), *bounds)


# .replace and the regular expressions of Java


def test_replace_changes_every_match(mind):
    assert mind.result(".replace", String("a-b-c"), String("-"), String("+")) == '"a+b+c"'
    assert mind.result(".replace", String("a1b22"), String("[0-9]+"), String("#")) == '"a#b#"'
    assert mind.result(".replace", ("f", "x"), String("x"), String("y")) == '"f(y)"'
    assert not mind.succeeds(".replace", String("a"), String("a"), String("b"), String("a"))
    with pytest.raises(ActionError, match=r"\.replace"):
        mind.succeeds(".replace", String("a"), String("["), String("b"), Var("R"))


@pytest.mark.parametrize("arguments", [(String("a"), "a", String("b")), (String("a"), String("a"), 1)])
def test_replace_needs_strings(mind, arguments):
    with pytest.raises(WrongArguments):
        mind.succeeds(".replace", *arguments, Var("R"))


@pytest.mark.parametrize(
    ("source", "pattern", "by", "replaced"),
    [
        ("john smith", r"(\w+) (\w+)", "$2 $1", "smith john"),
        ("john smith", r"(\w+) (\w+)", r"\2 \1", "smith john"),
        ("ab", r"(x)?b", "[$1]", "a[]"),
        ("cost", "cost", "$", "$"),
        ("é1", r"\w", "x", "éx"),
        ("aab", "a++", "x", "xb"),
        ("ab", "(?<!a)b|(?<=a)b", "x", "ax"),
    ],
)
def test_matches_are_replaced(source, pattern, by, replaced):
    assert replace_all(source, pattern, by) == replaced


@pytest.mark.parametrize(("pattern", "by"), [("a", "$1"), ("a", "\\"), (r"\p{Greek}", ""), ("(", "")])
def test_invalid_expressions_are_refused(pattern, by):
    with pytest.raises(ValueError, match="'"):
        replace_all("a", pattern, by)


# .upper_case .lower_case .term2string


def test_cases_of_letters(mind):
    assert mind.result(".upper_case", String("aBé1")) == '"ABÉ1"'
    assert mind.result(".lower_case", String("AbC")) == '"abc"'
    assert mind.result(".upper_case", ("f", "a")) == '"F(A)"'
    assert not mind.succeeds(".lower_case", String("A"), String("A"))


def test_term2string_writes_and_reads_terms(mind):
    assert mind.result(".term2string", ("b", [1, String("s")])) == '"b([1,"s"])"'
    assert mind.result(".term2string", String("s")) == '""s""'
    assert mind.succeeds(".term2string", "b", String("b"))
    assert not mind.succeeds(".term2string", "b", String("c"))
    mind.readable = {"f(X)": structure("f", 5.0), "10": 10.0, "b": structure("b")}
    read = Var("T")
    assert mind.instances(".term2string", read, String("10"), of=read) == ["10"]
    assert mind.succeeds(".term2string", read, String("f(X)"))
    assert text(read) == "f(5)"
    other = Var("U")
    assert mind.succeeds(".term2string", other, "b")
    assert text(other) == "b"
    read = Var("T")
    assert mind.succeeds(".term2string", read, String("not a ( term"))
    assert mind.succeeds(".atom", read)
    assert text(read) == "not a ( term"
    with pytest.raises(ActionError):
        mind.succeeds(".term2string", "b", "b")
