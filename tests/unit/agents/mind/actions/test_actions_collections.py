"""Internal actions on lists, strings, sets, maps and queues."""

import pytest
from action_answers import answers, calls

from jacaros.agents.mind.actions.internal_action import STANDARD

LISTS = """
.length([], X) => 0
.length([a,[b,c]], X) => 2
.length("wörd", X) => 4
.length("", X) => 0
.set.create(S) & .set.add_all(S, [1,2,2]) & .length(S, X) => 2
.map.put(M, k, 1) & .length(M, X) => 1
.queue.add_all(Q, [1,1]) & .length(Q, X) => 2
.length([1,2|T], X) => 2
.length([a], 2) => no
.length(a, X) => no
.length(L, X) => no

.empty([]) => yes
.empty("") => yes
.set.create(S) & .empty(S) => yes
.queue.create(Q) & .empty(Q) => yes
.map.create(M) & .empty(M) => yes
.empty([a]) => no
.empty("a") => no
.set.add(S, 1) & .empty(S) => no
.empty(a) => no
.empty(0) => no
.empty(X) => no

.member(X, [c,a,b,a]) => c | a | b | a
.member(X, []) => no
.member(b(X), [b(1),c(2),b(3),b(4,5)]) => 1 | 3
.member(p(X,z), [p(1,a),p(2,z)]) => 2
.member(p, [p[a]]) => yes
.member(p[a], [p]) => no
.set.add_all(S, [b,a]) & .member(X, S) => a | b
.queue.add_all(Q, [b,a,b]) & .member(X, Q) => b | a | b
.set.add(S, b) & .member(b, S) => yes
.queue.add_all(Q, [b,b]) & .member(b, Q) => yes
.set.add(S, b) & .member(z, S) => no
.set.add(S, p[a]) & .member(p, S) => no
.member(X, a) => wrong: the second argument of .member must be a list, a set or a queue, not a
.member(X, 1) => wrong: the second argument of .member must be a list, a set or a queue, not 1
.member(X, "abc") => wrong: the second argument of .member must be a list, a set or a queue, not "abc"
.member(X, L) => wrong: the second argument of .member must be a list, a set or a queue, not L
.map.create(M) & .member(X, M) => wrong: the second argument of .member must be a list, a set or a queue, not {}

.nth(0, [a,b,c], X) => a
.nth(2.9, [a,b,c], X) => c
.nth(0, [a], b) => no
.nth(X, [x,y,x], x) => 0 | 2
.nth(X, [x,y], Y) => 0 x | 1 y
.nth(X, [x], z) => no
.nth(X, [a,1,5], X) => 1
.nth(1, "aéb", X) => "é"
.nth(-1, [a,b,c], X) => error: .nth: position -1 is outside the 3 elements
.nth(3, [a,b,c], X) => error: .nth: position 3 is outside the 3 elements
.nth(5, [a,b,c], X) => error: .nth: position 5 is outside the 3 elements
.nth(a, [a], X) => wrong: the first argument of .nth must be a number, not a
.nth(0, a, X) => wrong: the second argument of .nth must be a list, not a
.nth(I, 1, X) => wrong: the second argument of .nth must be a list, not 1

.concat([a], [], [b,c], [d], X) => [a,b,c,d]
.concat([a], [b], [a,b]) => yes
.concat([a], [b], [b,a]) => no
.concat([a], [b|T], X) => [a,b|T]
.concat([b|T], [a], X) => error: .concat: [b|T] has an open tail
.concat("a b", 1, a, f("s"), X) => "a b1af("s")"
.concat(x, [a], X) => "x[a]"
.concat("a", "b", ab) => yes
.concat("a", "b", "a") => no
.concat('x y', z, f('q'), X) => "x yzf('q')"
.concat([a], b, X) => wrong: argument 2 of .concat must be a list, not b
.concat([a], [b], "ab") => error: .concat: the last argument must be a list or a variable, not "ab"

.delete(a, [a,b,a,c], X) => [b,c]
.delete(f(Y), [f(1),g(2),f(3),f(1)], X) => [g(2),f(3)] Y
.delete(z, [a], X) => [a]
.delete(3, [a,b,a,c,a], X) => [a,b,a,a]
.delete(9, [a], X) => [a]
.delete(1, 3, [a,b,c,a], X) => [a,a]
.delete(0, 4, [a,b,c,d,e], X) => [e]
.delete(0, "banana", X) => "anana"
.delete(2, 4, "abcdef", X) => "abef"
.delete(6, "banana", X) => "banana"
.delete(2, 9, "abc", X) => "abc"
.delete("a", "banana", X) => "bnn"
.delete("[0-9]+", "a1b22", X) => "ab"
.delete("a", [a,b], X) => "[,b]"
.delete(Any, [a,1,a], X) => [1]
.delete(a, [a,b], []) => no
.delete(a, b, X) => wrong: the second argument of .delete must be a list, not b
.delete(1, b, X) => wrong: the list or string of .delete must be a list, not b
.delete("(", "b", X) => error: .delete: invalid regular expression '(': missing ), unterminated subpattern at position 0

.reverse([1,[2,3],4], X) => [4,[2,3],1]
.reverse([], X) => []
.reverse("abc", X) => "cba"
.reverse(f(1), X) => ")1(f"
.reverse([1,2|T], X) => [2,1|T]
.reverse([1,2], [1,2]) => no
.reverse([1], "x") => wrong: the second argument of .reverse must be a list, not "x"
.reverse("ab", [1]) => wrong: the second argument of .reverse must be a string, not [1]
.reverse("ab", ba) => wrong: the second argument of .reverse must be a string, not ba

.sort([X,b,[a],"s",2,a,a(1),2,-1], Y) => X [-1,2,2,"s",[a],a,a(1),b,X]
.sort([3,2], [2,3]) => yes
.sort([3,2], [3,2]) => no
.sort("ba", X) => wrong: the first argument of .sort must be a list, not "ba"
.shuffle([1,2,3,4,5,6,7,8], S) & .sort(S, X) => [1,2,3,4,5,6,7,8]
.shuffle(a, X) => wrong: the first argument of .shuffle must be a list, not a

.max([b,c,10,g,f(10),5,f(4)], X) => g
.min([b,[3,4],5,[3],f(4)], X) => 5
.max([3,2,5], 5) => yes
.max([3,2,5], 2) => no
.max([], X) => no
.min([], X) => no
.max(Y, b(Y), X) => 7 Y
.min(p(Y), b(Y), X) => p(2) Y
.max(Y, b(Y), 7) => Y
.max(Y, d(Y), X) => no
.max(notalist, X) => wrong: the first argument of .max must be a list, not notalist
.min(notalist, X) => wrong: the first argument of .min must be a list, not notalist

.range(X, 1, 4) => 1 | 2 | 3 | 4
.range(X, 1, 6, 2) => 1 | 3 | 5
.range(X, 3, 1, -1) => 3 | 2 | 1
.range(X, 3, 1) => no
.range(3, 1, 5) => yes
.range(6, 1, 5) => no
.range(2, 1, 5, 2) => yes
.range(a, 1, 2) => wrong: the first argument of .range must be a number, not a
.range(X, a, 2) => wrong: the second argument of .range must be a number, not a
.range(X, 1, E) => wrong: the third argument of .range must be a number, not E
.range(X, 1, 2, b) => wrong: the fourth argument of .range must be a number, not b
.range(X, 1, 2, 0) => wrong: the step of .range must not be 0

.union([a,b,a,c], [f,e,a], X) => [a,b,c,e,f]
.intersection([c,b,a,c], [c,a,x,a], X) => [a,c]
.difference([a,b,a,c], [f,a,c], X) => [b]
.difference([], [a], X) => []
.union([a], [b], [a]) => no
.union([p[a]], [p], X) => [p,p[a]]
.intersection([p[a]], [p], X) => []
.union(a, [], X) => wrong: the first argument of .union must be a list, not a
.union([], a, X) => wrong: the second argument of .union must be a list, not a
.union([], [], a) => wrong: the third argument of .union must be a list, not a
.intersection(a, [], X) => wrong: the first argument of .intersection must be a list, not a
.difference([], a, X) => wrong: the second argument of .difference must be a list, not a
.difference([], [], a) => wrong: the third argument of .difference must be a list, not a

.sublist(X, [a,b,c]) => [a,b,c] | [a,b] | [a] | [b,c] | [b] | [c] | []
.sublist(X, []) => []
.sublist([a,X], [a,1,a,2]) => 1 | 2
.sublist([], [a]) => yes
.sublist([a,c], [a,b,c]) => no
.sublist([b|X], [a,b,c]) => [c] | []
.prefix(X, [a,b]) => [a,b] | [a] | []
.suffix(X, [a,b]) => [a,b] | [b] | []
.prefix([a], [a,b]) => yes
.prefix([b], [a,b]) => no
.suffix([b], [a,b]) => yes
.suffix([a], [a,b]) => no
.prefix(X, "ab") => "ab" | "a" | ""
.suffix(X, "ab") => "ab" | "b" | ""
.prefix("ab", "abc") => yes
.suffix("ab", "abc") => no
.sublist(a, [a]) => wrong: the first argument of .sublist must be a part or a variable, not a
.sublist([a], a) => wrong: the second argument of .sublist must be a list, not a
.prefix("a", [a]) => wrong: the first argument of .prefix must be a part or a variable, not "a"
.suffix(P, L) => wrong: the second argument of .suffix must be a list, not L
"""


@calls(LISTS)
def test_what_actions_on_lists_and_strings_answer(formula, wanted):
    assert answers(formula) == wanted


def test_a_shuffle_follows_the_seed():
    shuffled = ".shuffle([1,2,3,4,5,6,7,8,9,10,11,12], X)"
    assert answers(shuffled) == answers(shuffled) != "[1,2,3,4,5,6,7,8,9,10,11,12]"
    assert (
        answers(shuffled.replace("X", "Y") + f" & {shuffled}") != f"{answers(shuffled)} {answers(shuffled)}"
    )


def test_sets_made_of_long_lists_are_equal_by_their_elements():
    long = str(list(range(5000))).replace(" ", "")
    assert answers(f".union([{long}], [{long}], X)") == f"[{long}]"
    assert answers(f".difference([{long}], [{long}], X)") == "[]"


COLLECTIONS = """
.set.create(S) & .set.create(S) => no
.map.create(M) & .map.create(M) => no
.queue.create(Q) & .queue.create(Q) => no
.set.create(1) => no

.set.add(X, b) & .set.add(X, a) & .set.add(X, b) & .set.to_list(X, Y) => {a,b} [a,b]
.set.add_all(X, [a,b]) & .set.remove(X, b) & .set.remove(X, z) => {a}
.set.add(X, 1) & .set.copy(X, Y) & .set.clear(X) => {} {1}
.set.add(S, z) & .queue.add(Q, q) & .set.add_all(X, [c,b,c]) & .set.add_all(X, S) & .set.add_all(X, Q) => {b,c,q,z}
.set.add(S, z) & .queue.add(Q, q) & .set.union(X, [c,b,c]) & .set.union(X, S) & .set.union(X, Q) => {b,c,q,z}
.set.add(X, z) & .set.add_all(X, X) => {z}
.set.add(X, z) & .set.union(X, X) => {z}
.set.add_all(X, [1,2,3]) & .set.intersection(X, [2,3,9]) => {2,3}
.set.add_all(X, [2,3]) & .set.difference(X, [2,9]) => {3}
.set.add_all(X, [2,3]) & .set.difference(X, X) => {}
.set.add_all(S, [1,2]) & .set.add_all(T, [2,1]) & .copy_term(S, T) => yes
.set.add_all(S, [1,2]) & .set.add_all(T, [2,1,3]) & .copy_term(S, T) => no

.map.put(X, b, 1) & .map.put(X, a, 2) & .map.put(X, b, [3]) & .map.get(X, b, Y) => {a->2,b->[3]} [3]
.map.put(M, b, 3) & .map.get(M, b, 1) => no
.map.put(M, b, 3) & .map.get(M, z, X) => no
.map.create(M) & .map.get(M, z, X, none) => none
.map.put(M, b, 1) & .map.put(M, a, 2) & .map.put(M, c, 1) & .map.key(M, X) => a | b | c
.map.put(M, b, 1) & .map.put(M, a, 2) & .map.put(M, c, 1) & .map.value(M, X) => 2 | 1 | 1
.map.put(M, b, 1) & .map.key(M, b) => yes
.map.put(M, b, 1) & .map.value(M, 9) => no
.map.put(X, a, 1) & .map.put(X, b, 2) & .map.remove(X, a, Y) => {b->2} 1
.map.put(M, a, 1) & .map.remove(M, a) & .map.remove(M, a, X) => no
.map.put(X, b, 2) & .map.remove(X, b) => {}
.map.put(X, a, 1) & .map.copy(X, Y) & .map.clear(X) => {} {a->1}

.queue.add_all(Q, [c,a]) & .queue.add(Q, b) & .queue.head(Q, X) & .queue.to_list(Q, Y) => c [c,a,b]
.queue.add_all(Q, [c,a,b]) & .queue.remove(Q, X) & .queue.remove(Q, Y) & .queue.remove(Q, Z) => c a b
.queue.create(Q) & .queue.head(Q, X) => no
.queue.create(Q) & .queue.remove(Q, X) => no
.queue.create(X, priority) & .queue.add_all(X, [t(5,e),t(1,a),t(3,c)]) & .queue.head(X, Y) => [t(1,a),t(3,c),t(5,e)] t(1,a)
.queue.create(Q, priority) & .queue.add_all(Q, [5,1,3]) & .queue.remove(Q, X) & .queue.remove(Q, Y) => 1 3
.queue.create(X, priority) & .queue.add_all(X, [2,1]) & .queue.copy(X, Y) & .queue.clear(X) & .queue.add(Y, 0) => [] [0,1,2]

.set.add_all(C, a) => wrong: the second argument must be a list, a set or a queue, not a
.set.union(C, a) => wrong: the second argument must be a list, a set or a queue, not a
.set.intersection(C, a) => wrong: the second argument must be a list, a set or a queue, not a
.set.difference(C, a) => wrong: the second argument must be a list, a set or a queue, not a
.queue.add_all(C, a) => wrong: the second argument must be a list, a set or a queue, not a
"""


@calls(COLLECTIONS)
def test_what_actions_on_collections_answer(formula, wanted):
    assert answers(formula) == wanted


UNBOUND = """
.set.add(X, 1) => {1}
.set.add_all(X, [1]) => {1}
.set.union(X, [1]) => {1}
.set.intersection(X, [1]) => {}
.set.difference(X, [1]) => {}
.set.remove(X, 1) => {}
.set.to_list(X, L) => {}
.set.copy(X, D) => {}
.set.clear(X) => {}
.map.put(X, k, 1) => {k->1}
.map.get(X, k, V, 0) => {}
.map.remove(X, k) => no
.map.key(X, K) => no
.map.value(X, V) => no
.map.copy(X, D) => {}
.map.clear(X) => {}
.queue.add(X, 1) => [1]
.queue.add_all(X, [1]) => [1]
.queue.head(X, E) => no
.queue.remove(X, E) => no
.queue.to_list(X, L) => []
.queue.copy(X, D) => []
.queue.clear(X) => []
"""


@calls(UNBOUND)
def test_an_unbound_variable_becomes_a_collection(formula, wanted):
    assert answers(formula) == wanted


@calls(UNBOUND)
def test_any_other_first_argument_is_wrong(formula, wanted):
    del wanted
    kind = formula.split(".")[1]
    for other in ("1", "[a]", ".set.create(X)", ".map.create(X)", ".queue.create(X)"):
        if f".{kind}." not in other:
            call = f"{other} & {formula}" if "create" in other else formula.replace("X", other, 1)
            assert answers(call).startswith(f"wrong: the first argument must be a {kind}, not "), call


def test_every_action_on_collections_is_tested_here():
    names = {
        name for name in STANDARD if name.split(".")[1] in ("set", "map", "queue") and name.count(".") == 2
    }
    tested = {formula.partition("(")[0] for formula in UNBOUND.split("\n")}
    assert names - tested == {".set.create", ".map.create", ".queue.create"}


@pytest.mark.parametrize("name", [".set.create", ".map.create", ".queue.create"])
def test_only_an_unbound_variable_can_become_a_new_collection(name):
    assert answers(f"{name}(1)") == "no"
