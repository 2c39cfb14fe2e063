"""Reasoning cycles: fuel, depth, and turns."""

from pathlib import Path

import pytest
from recording_host import mind, printed, programs

from jacaros.agents.mind.state.act import Completion

CASES = Path(__file__).parents[3] / "conformance"


AREAS = ("beliefs", "plan_selection", "body_statements", "failure", "intentions", "rules_and_queries", "time")


def single_agent_cases() -> list[Path]:
    return [path for area in AREAS for path in sorted((CASES / area).glob("*.asl"))]


@pytest.mark.parametrize("case", single_agent_cases(), ids=lambda path: f"{path.parent.name}/{path.stem}")
@pytest.mark.parametrize("fuel", [1, 3, 100_000])
def test_staying_with_an_intention_is_invisible_to_programs(case, fuel):
    host = mind(
        case.read_text(), name=case.stem, path=str(case), complete=lambda act: Completion(success=False)
    )
    host.run(fuel)
    expected = [
        line.partition("] ")[2]
        for line in case.with_suffix(".expected").read_text().splitlines()
        if line[:1] == "["
    ]
    assert host.printed == expected
    assert host.stopped


def test_a_tail_recursive_goal_needs_constant_space():
    host = mind("!g(100000). +!g(0) <- .stopMAS. +!g(N) : N > 0 <- !g(N-1).")
    deepest = 0
    while host.agent.run(997):
        deepest = max([deepest, *(len(i.frames) for i in host.agent.alive.values())])
    assert host.stopped
    assert deepest == 1


PROGRAMS = """
ten thousand nested goals need no python recursion => 10000
    !g(10000,S). +!g(0,0). +!g(N,S) : N > 0 <- !g(N-1,T); S = T+1; if (N == 10000) { .print(S) }.
a rule a hundred thousand levels deep needs no python recursion => deep
    n(0). n(X) :- X > 0 & n(X-1). !s. +!s : n(100000) <- .print(deep).
an ended goal is reported as achieved and finished
=> bachieved | bfinished | cdropped | cfinished | aachieved | afinished
    !a. !b. !w.
    +!a <: done <- !c.
    +!c <- .wait(10000).
    +!b <- .wait(10000).
    +!w <- .wait(10); .succeed_goal(b); +done.
    ^!a[state(S)] : .member(S, [achieved, finished]) <- .print(a, S).
    ^!b[state(S)] : .member(S, [achieved, finished]) <- .print(b, S).
    ^!c[state(S)] : .member(S, [dropped, finished]) <- .print(c, S).
programs see the annotations of labels => 2 | 1 | own | bob
    !s.
    @greet[cost(2), polite] +!greet.
    +!s
      <- .plan_label(P, greet[cost(C)]); .print(C);
         .findall(L, .plan_label(_, L[polite]), Ls); .length(Ls, N); .print(N);
         .relevant_plans({+!greet}, _, [M]); if (greet[source(self)] = M) { .print(own) };
         .add_plan({ @told +!h }, bob); if (.plan_label(_, told[source(S)])) { .print(S) }.
the plan of a suspended goal is chosen when it is resumed => changed | sub(2) | g2
    !g. !k. c(1).
    +!g <- !sub; .print(g2).
    +!sub : c(X) <- .print(sub(X)).
    +!k <- .suspend(g); -+c(2); .print(changed); .resume(g).
a belief change without plan takes its turn in the event queue => b1 | b2 | c1 | a1 | c2 | a2
    !g1. !g2. !g3.
    +!g1 <- +b; .print(a1); .print(a2).
    +!g2 <- .print(b1); .print(b2).
    +!g3 <- .print(c1); .print(c2).
replacing a belief with annotations replaces one that has them => del(2,[foo,source(self)]) | [9,1]
    !g. p(1). p(2)[foo].
    +!g <- -+p(9)[foo]; .findall(X, p(X), L); .print(L).
    -p(X)[|R] <- .print(del(X,R)).
beliefs with very long lists are found counted once and deleted => event | held | equal | 10
    !g.
    +!g <- .findall(X,.range(X,1,5000),L); .findall(X,.range(X,1,5000),M);
      +l(L); +l(M); .count(l(_),N); if (l(M)) { .print(held) }; -l(L); .count(l(_),K);
      if (k(L) == k(M)) { .print(equal) };
      .print(N, K).
    +l(_) <- .print(event).
done ends the goal immediately => h1 | after
    !g. +!g <- !h; .print(after). +!h <- .print(h1); .done; .print(no).
an intention whose wait ended while suspended is ready at its resume => g2 | resumed | r2
    !g. !k.
    +!g <- .wait(10); .print(g2).
    +!k <- .wait(5); .suspend(g); .wait(20); .resume(g); .print(resumed); .print(r2).
goals of a dropped intention are not desires => gone
    !g. !k. !x. !x. !x.
    +!g <- !h(1).
    +!k <- .drop_intention(g); if (.desire(h(_))) { .print(bad) } else { .print(gone) }.
    +!h(_). +!x.
the stack of an intention shows its goal and remaining steps => 1 | { .print(Y); .print(B); .wait(1) }
    !g(1).
    +!g(X) <- .intention(_, running, [im(_, { +!g(Y) }, { _; B }, _)|_], current); .print(Y); .print(B); .wait(X).
a body held by a variable runs its first step in the same turn => a1 | b1 | a2 | b2 | a3 | b3 | b4 | b5
    !a. !b.
    +!a <- B = {.print(a1); .print(a2)}; B; .print(a3).
    +!b <- .print(b1); .print(b2); .print(b3); .print(b4); .print(b5).
beliefs may change while a loop goes over them => 1 | 1 | 2 | 4 | 5 | end
    !g. p(1). p(2). p(3). p(4). p(5). ok. r(X) :- p(X) & ok.
    +!g <- for (r(X)) { .print(X); if (X == 1) { -ok } }; for (p(X)) { .print(X); -p(X+2) }; .print(end).
a plan is removed with its last source => 1 | no_relevant
    !g.
    +!g <- .add_plan({@k +!a <- .print(1)}, bob); .add_plan({@k +!a <- .print(1)}, carl); .remove_plan(k, bob); !a;
      .remove_plan(k, carl); !a.
    -!g[error(E)] <- .print(E).
the label of a plan without a file names no file => [k[source(self)]]
    !g. +!g <- .add_plan("@k +!a."); .relevant_plans({+!a}, _, L); .print(L).
removing an unknown plan succeeds => []
    !g. @k +!a. +!g <- .remove_plan(none); .remove_plan([k, none]); .relevant_plans({+!a}, L); .print(L).
dropping all intentions cancels planned events => now | later | end
    !s.
    +!s <- .at("now +1 s", {+!late}); .at("now", {+!now}); .wait(10); .drop_all_intentions;
           .at("now +1 s", {+!later}); .wait(3000); .print(end).
    +!late <- .print(late).
    +!now <- .print(now).
    +!later <- .print(later).
a literal can be taken apart without its namespace => a[1][x]a
    !go.
    +!go <- n::a(1)[x] =.. [F, T, A]; a =.. [G, [], []]; .print(F, T, A, G); L = [b, [2], [y]]; b(2)[y] =.. L.
goal state events keep their order and carry the reason
=> pending  | executing  | failed ia_failed | executing has_failure_plan | achieved  | finished  | end
    !g.
    +!g <- !h; .wait(5); .print(end).
    +!h <- .fail.
    -!h.
    ^!h[state(S)[reason(R)]] <- .print(S, " ", R).
goal state events report suspension and resumption of waiting goals
=> pending  | suspended suspend_ia | resumed resume_ia | pending  | executing  | waiting wait(6)[time(20)]
| suspended suspend_ia | resumed resume_ia | waiting wait(6)[time(20)] | executing  | suspended suspend_ia | end
    !g.
    +!g <- !!h; .suspend(h); .wait(5); .resume(h); .wait(5); .suspend(h); .resume(h); .wait(20); .print(end).
    +!h <- .wait(20); .suspend.
    ^!h[state(S)[reason(R)]] <- .print(S, " ", R).
"""


@programs(PROGRAMS)
def test_what_a_program_prints(program, output):
    assert printed(program) == output


def test_done_ends_a_handler_and_a_test_without_value_fails():
    assert printed("!s. +!s <- !g; .print(after). +!g <- .fail. -!g <- .done; .print(no).") == ["after"]
    assert printed("!g. +!g <- +b; .print(x). +b <- .print(b); .done; .print(no).") == ["b", "x"]
    program = "b(1). !go. +!go <- ?X; .print(X). -!go[error(E)] <- .print(E)."
    assert printed(program) == ["body_var_without_value"]
    assert printed("b(1). !go. +!go <- X = b(Y); ?X; .print(Y).") == ["1"]


@pytest.mark.whole_stack
def test_plans_of_any_width_are_compiled():
    context = " & ".join(f"X > {i}" for i in range(150))
    nots = " & ".join(f"not q({i})" for i in range(150))
    arguments = ",".join(str(i) for i in range(120))
    assert printed(
        f"""
        !s.
        +!s <- !a(200); !b; !c({arguments}).
        +!a(X) : {context} <- .print(a).
        +!b : {nots} <- .print(b).
        +!c({arguments}) <- .print(c).
        """
    ) == ["a", "b", "c"]


def test_ending_a_goal_of_a_suspended_intention_resumes_its_caller_immediately():
    lines = printed(
        """
        !g. !k.
        +!g <- !h; .print(a).
        +!h <- .wait(100); .print(no).
        +!k <- .wait(1); .suspend(h); .succeed_goal(h); .print(k); .wait(10); .print(k2).
        """
    )
    assert sorted(lines) == ["a", "k", "k2"]
    assert lines.index("a") < lines.index("k2")


def test_a_context_may_ask_for_the_intention_of_its_event():
    program = """
!a. !b.
+!a <- .wait(10); !c.
+!b <- .wait(10); .wait(10); +e.
+!c : .intention(I, S, _, current) <- .print(I, S).
+!c <- .print("no intention").
+e : .intention(I, _, _, current) <- .print(I).
+!new : .intention(_, _, _, current) <- .print("the last one").
+!new <- .print("a new one").
!!new.
"""
    assert sorted(printed(program.replace("!!new", "!new"))) == ["1running", "2", "a new one"]


PROGRAMS = {
    "the goal condition holds when nothing else is left to do": """
        !start.
        +!start <- !!wait; !reach; .print(reached).
        +!reach <: done <- .print(tried).
        +!wait <- .wait(10); +done.
        """,
    "falling asleep": """
        !start.
        +!start <- .print(working).
        +jag_sleeping <- .print(asleep).
        """,
    "two intentions": """
        !a(3). !b(3).
        +!a(0). +!a(N) <- .print(a, N); !a(N - 1).
        +!b(0). +!b(N) <- .print(b, N); !b(N - 1).
        """,
}


@pytest.mark.parametrize("kind", PROGRAMS)
def test_single_cycles_have_the_same_effect(kind):
    printed = []
    for fuel in (1000, 7, 2, 1):
        host = mind(PROGRAMS[kind])
        host.run(fuel)
        printed.append(host.printed)
    assert printed[0]
    assert printed == [printed[0]] * 4
