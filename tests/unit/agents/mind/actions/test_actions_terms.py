"""Internal actions on terms, their types, strings, time and chance."""

import pytest
from action_answers import answers, calls
from recording_host import mind

from jacaros import __version__
from jacaros.agents.mind.actions.internal_action import STANDARD
from jacaros.agents.mind.actions.terms import replace_all

TERMS = r"""
.copy_term(f(X,Y,X,1), C) & .copy_term(C, f(x,y,Z,1)) => X Y x
.rename_apart(f(X,Y,X,1), C) & .copy_term(C, f(x,y,Z,1)) => X Y x
.copy_term(f(1), X) => f(1)
.copy_term(f(1), f(2)) => no

.add_annot(a, source(jomi), X) => a[source(jomi)]
.add_annot(a[z], b, X) => a[b,z]
.add_annot(a[b], b, X) => a[b]
.add_annot(a, source(jomi), b) => no
.add_annot(a[b|T], c, X) => a[b,c|T]
.add_annot([a,f(1),[g(2)]], x, X) => [a[x],f(1)[x],[g(2)[x]]]
.add_annot([1,Y], x, X) => [1,Y] Y
.add_annot(a, b, a) => no
.add_annot(a, b, a[b,c]) => yes
.add_nested_source(p(1), pluto, X) => p(1)[source(pluto)]
.add_nested_source(p(1)[source(venus)], pluto, X) => p(1)[source(pluto)[source(venus)]]
.add_nested_source(p[source(a)[source(b)],t], c, X) => p[source(c)[source(a)[source(b)]],t]
.add_nested_source([a,1,[b(2)]], c, X) => [a[source(c)],1,[b(2)[source(c)]]]
.remove_source_annot(p[source(a),source(b)[source(c)],t], X) => p[t]
.remove_source_annot(p[source(a)], X) => p
.remove_source_annot(p, X) => p
.remove_source_annot([p[source(a)],1], X) => [p,1]
.remove_source_annot({ @l[source(bob)] +!g }, X) => { @l +!g }

.type(1, X) => number | ground
.type(Y+1, X) => number Y
.type(a, X) => atom | literal | ground
.type(ns::a, X) => atom | literal | ground
.type(~a, X) => literal | structure | ground
.type(a[b], X) => literal | structure | ground
.type(f(1), X) => literal | structure | ground
.type(~f(1), X) => literal | structure | ground
.type(f(Y), X) => literal Y | structure Y
.type(.print(a), X) => literal | structure | ground
.type("s", X) => string | ground
.type([1], X) => list | structure | ground
.type([], X) => list | structure | ground
.type([1|T], X) => list | structure
.set.create(S) & .type(S, X) => set | ground
.map.create(M) & .type(M, X) => map | ground
.queue.create(Q) & .type(Q, X) => queue | ground
.type({ h :- b }, X) => literal | structure | rule | ground
.type({ !g; a }, X) => literal | structure | plan | ground
.type(Y, X) => free Y
.type(1, integer) => no
.type(a[b], literal) => yes
.atom([]) => no
.literal([]) => no
.internal_action(.print(a)) => yes
.internal_action(print(a)) => no
.internal_action(V) => no

.substring("b", "abc") => yes
.substring("x", "abc") => no
.substring(a(10), b(t1,a(10))) => yes
.substring("", "") => yes
.substring("a", "bab", 1) => yes
.substring("a", "bab", 0) => no
.substring("an", "banana", 3, 4) => yes
.substring("a", "abbacca", X) => 0 | 3 | 6
.substring(a(10), b(t1,a(10)), X) => 5
.substring("an", "banana", X, Y) => 1 2 | 3 4
.substring("aa", "aaa", X) => 0 | 1
.substring("x", "abc", X) => no
.substring("", "ab", X) => 0 | 1
.substring(X, "hello world", 6) => "world"
.substring(X, "hello world", 0, 5) => "hello"
.substring(X, a(10,20), 5, 7) => "20"
.substring(X, "ab", 2) => ""
.substring("hello", X, 1, 3) => "el"
.substring(X, "abc", -1) => error: .substring: part -1 to 3 is outside the 3 characters
.substring(X, "abc", 4) => error: .substring: part 4 to 3 is outside the 3 characters
.substring(X, "abc", 2, 1) => error: .substring: part 2 to 1 is outside the 3 characters
.substring(X, "abc", 0, 9) => error: .substring: part 0 to 9 is outside the 3 characters

.replace("a-b-c", "-", "+", X) => "a+b+c"
.replace("a1b22", "[0-9]+", "#", X) => "a#b#"
.replace(f(x), "x", "y", X) => "f(y)"
.replace("a", "a", "b", "a") => no
.replace("a", "[", "b", X) => error: .replace: invalid regular expression '[': unterminated character set at position 0
.replace("a", a, "b", X) => wrong: the second argument of .replace must be a string, not a
.replace("a", "a", 1, X) => wrong: the third argument of .replace must be a string, not 1
.upper_case("aBé1", X) => "ABÉ1"
.lower_case("AbC", X) => "abc"
.upper_case(f(a), X) => "F(A)"
.lower_case("A", "A") => no

.term2string(b([1,"s"]), X) => "b([1,"s"])"
.term2string("s", X) => ""s""
.term2string(b, "b") => yes
.term2string(b, "c") => no
.term2string(b, b) => error: .term2string: the second argument must be a string, not b
.term2string(X, "10") => 10
.term2string(X, b) => b
.term2string(Y, "f(5)") & .type(Y, X) => literal f(5) | structure f(5) | ground f(5)
.term2string(Y, "not a ( term") & .type(Y, X) => atom not a ( term | literal not a ( term | ground not a ( term

.time(X, Y, Z) => 22 15 23
.time(W, X, Y, Z) => 22 15 23 456
.time(22, 15, X) => 23
.time(0, X, Y) => no
.date(X, Y, Z) => 2023 11 14
.date(2023, 11, 14) => yes
.date(2023, 11, 15) => no
.nano_time(1) => no
.nano_time(X) & .type(X, number) => 1700000123456000000

.random([], X) => no
.random([], X, 0) => no
.random([a], X, 3) => a | a | a
.random(1) => wrong: .random expects a list or a variable, and a variable after a list, not 1
.random(a) => wrong: .random expects a list or a variable, and a variable after a list, not a
.random(X, a) => wrong: the number of answers of .random must be a number, not a
.random([a], b) => wrong: .random expects a list or a variable, and a variable after a list, not b
.random([a], X, n) => wrong: the number of answers of .random must be a number, not n
.random([a]) => wrong: .random expects a list or a variable, and a variable after a list, not 1
.set_random_seed("x") => wrong: the argument of .set_random_seed must be a number, not "x"

.my_name(X) => tester
.my_name(carl) => no
.all_names(X) => [tester,friend]
.verbose(loud) => wrong: the argument of .verbose must be a number, not loud
.verbose(-1) => wrong: the argument of .verbose must be 0, 1 or 2, not -1
.verbose(3) => wrong: the argument of .verbose must be 0, 1 or 2, not 3
"""
A_MOMENT = 1_700_000_123.456  # 2023-11-14 22:15:23.456 UTC


@calls(TERMS)
def test_what_actions_on_terms_answer(formula, wanted):
    host = mind("")
    host.time = A_MOMENT
    assert answers(formula, host) == wanted


@calls("\n".join(line for line in TERMS.split("\n") if line.startswith(".type(") and ", X) =>" in line))
@pytest.mark.parametrize("kind", ["number", "atom", "literal", "string", "list", "structure", "ground"])
def test_each_type_has_its_test(formula, wanted, kind):
    tested = formula.removeprefix(".type(").removesuffix(", X)")
    assert (answers(f".{kind}({tested})") != "no") is (kind in wanted.split())


def test_random_numbers_are_drawn_one_by_one():
    drawn = answers(".random(X, 5)").split(" | ")
    assert len(set(drawn)) == 5
    assert all(0 <= float(number) < 1 for number in drawn)
    assert answers(".set_random_seed(7) & .random(X)") == answers(".set_random_seed(7) & .random(X)")
    assert len(answers(".random([a,b], X, 3)").split(" | ")) == 3


def test_verbose_and_version_are_known():
    host = mind("")
    assert answers(".verbose(2)", host) == "yes"
    assert host.agent.options.verbose == 2
    assert answers(".version(X)") == f'"{__version__}"'
    assert STANDARD[".stopMAS"].suspends


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
