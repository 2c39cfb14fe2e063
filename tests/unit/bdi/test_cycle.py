"""The reasoning cycle: interleaving, failure, atomic plans, and the freedom to stay with an intention."""

from pathlib import Path

import pytest
from recording_host import mind, printed

from jacaros.bdi.deliberation import event_of, is_ready
from jacaros.bdi.meta_events import observe_goals
from jacaros.compiler.triggers import trigger
from jacaros.terms.values import BY_SELF, atom, functor

CASES = Path(__file__).parents[2] / "conformance"
AREAS = ("beliefs", "plan_selection", "body_statements", "failure", "intentions", "rules_and_queries", "time")


def single_agent_cases() -> list[Path]:
    return [path for area in AREAS for path in sorted((CASES / area).glob("*.asl"))]


@pytest.mark.parametrize("case", single_agent_cases(), ids=lambda path: f"{path.parent.name}/{path.stem}")
@pytest.mark.parametrize("fuel", [1, 3, 100_000])
def test_staying_with_an_intention_changes_nothing_a_program_can_see(case: Path, fuel: int) -> None:
    host = mind(case.read_text(), name=case.stem, path=str(case), complete=no_environment)
    host.run(fuel)
    expected = [
        line.partition("] ")[2]
        for line in case.with_suffix(".expected").read_text().splitlines()
        if line[:1] == "["
    ]
    assert host.printed == expected
    assert host.stopped


def no_environment(act: object) -> object:
    from jacaros.bdi.act import Completion

    del act
    return Completion(success=False)


def test_a_tail_recursive_goal_needs_constant_space() -> None:
    host = mind("!g(100000). +!g(0) <- .stopMAS. +!g(N) : N > 0 <- !g(N-1).")
    deepest = 0
    while host.agent.run(997):
        deepest = max([deepest, *(len(i.frames) for i in host.agent.alive.values())])
    assert host.stopped
    assert deepest == 1


def test_ten_thousand_nested_goals_need_no_python_recursion() -> None:
    assert printed(
        "!g(10000,S). +!g(0,0). +!g(N,S) : N > 0 <- !g(N-1,T); S = T+1; if (N == 10000) { .print(S) }."
    ) == ["10000"]


def test_a_rule_a_hundred_thousand_levels_deep_needs_no_python_recursion() -> None:
    assert printed("n(0). n(X) :- X > 0 & n(X-1). !s. +!s : n(100000) <- .print(deep).") == ["deep"]


def test_an_atomic_plan_is_never_interleaved() -> None:
    lines = printed(
        """
        !a. !b.
        @l[atomic] +!a <- .print(a1); !sub; .print(a3).
        +!sub <- .print(a2).
        +!b <- .print(b1); .print(b2).
        """
    )
    assert lines == ["a1", "a2", "a3", "b1", "b2"]


def test_while_an_atomic_plan_waits_everything_waits() -> None:
    lines = printed(
        """
        !a. !b.
        @l[atomic] +!a <- .print(a1); .wait(50); .print(a2).
        +!b <- .print(b1).
        """
    )
    assert lines == ["a1", "a2", "b1"]


def test_an_exception_in_an_internal_action_fails_that_step_only() -> None:
    host = mind(
        """
        !other. !g.
        +!other <- .wait(10); .print(other_lives).
        +!g <- .nth(9, [a], _); .print(bad).
        -!g[error(E)] <- .print(E).
        """
    )
    host.run()
    assert host.printed == ["internal_action", "other_lives"]


def test_a_lost_intention_is_reported_with_its_place() -> None:
    host = mind("!g.\n+!g <-\n  ?nothing(1).", name="lost")
    host.run()
    assert host.logged == [
        (
            "warning",
            (
                "the goal !g failed and has no plan for its failure: "
                "test_goal_failed, a test found no answer (lost.asl:3)\n"
                "  step: ?nothing(1)"
            ),
        )
    ]


def test_a_handler_that_posts_its_goal_again_retries() -> None:
    assert printed(
        """
        n(3). !g.
        +!g : n(0) <- .print(done).
        +!g : n(N) <- -+n(N-1); .print(try(N)); .fail.
        -!g <- !g.
        """
    ) == ["try(3)", "try(2)", "try(1)", "done"]


def test_a_failed_goal_gives_its_variables_back_to_the_handler_and_the_caller() -> None:
    assert printed(
        """
        !s.
        +!s <- !g(X, f(Y)); X = free; Y = free_too; .print(X, " ", Y).
        +!g(A, f(B)) <- A = 1; B = 2; .fail.
        -!g(A, f(B)) <- if (A == 1 | B == 2) { .print(bound) } else { .print(unbound) }.
        """
    ) == ["unbound", "free free_too"]


def test_bindings_made_before_a_goal_outlive_its_failure() -> None:
    assert (
        printed(
            """
        !s.
        +!s <- P = pair(A, B); A = 1; !g(P); .print(P); B = 3; .print(P).
        +!g(pair(_, Y)) <- Y = 2; .fail.
        -!g(_).
        """
        )[1]
        == "pair(1,3)"
    )


def test_variables_bound_in_a_loop_are_free_in_the_next_round_and_after_it() -> None:
    assert printed(
        """
        !s.
        +!s <- P = pair(A, B); for (.member(X, [1,2])) { A = X; .print(P) }; A = 9; B = 8; .print(P).
        """
    )[0::2] == ["pair(1,B)", "pair(9,8)"]


def test_a_variable_bound_on_one_branch_only_is_free_on_the_other() -> None:
    assert printed(
        """
        !s.
        +!s <- for (.member(X, [1,2,1])) { if (X == 1) { Y = one }; if (Y = other) { .print(free) } else { .print(Y) } }.
        """
    ) == ["one", "free", "one"]


def test_a_context_that_cannot_be_evaluated_is_reported_and_the_next_plan_is_tried() -> None:
    host = mind("!g(0). +!g(X) : 5 div X > 1 <- .print(bad). +!g(_) <- .print(second).")
    host.run()
    assert host.printed == ["second"]
    assert "cannot be evaluated" in host.logged[0][1]


def test_an_observer_hears_why_a_goal_failed() -> None:
    host = mind('!a. +!a <- !b. +!b <- .fail(error_msg("no way")). -!b.')
    heard: list[tuple[str, str, str]] = []
    observe_goals(host.agent, lambda state, goal, number, why: heard.append((state, goal, why)))
    host.run()
    assert [(goal, why) for state, goal, why in heard if state == "failed"] == [
        ("!b", 'internal_action, no way (tester.asl:1)\nstep: .fail(error_msg("no way"))')
    ]
    assert not any(why for state, goal, why in heard if state != "failed")


def test_an_observer_hears_of_every_change_of_a_goal() -> None:
    host = mind("!a. +!a <- !b; .wait(10); .suspend(a); .print(x). +!b <- .fail. -!b.")
    heard: list[tuple[str, str]] = []
    observe_goals(host.agent, lambda state, goal, number, why: heard.append((state, goal)))
    host.run()
    states = [state for state, goal in heard if goal == "!a"]
    assert states == ["executing", "waiting", "executing", "suspended"]
    assert [state for state, goal in heard if goal == "!b"] == [
        "pending",
        "executing",
        "failed",
        "executing",
        "finished",
    ]


def test_a_goal_that_is_ended_is_told_to_be_achieved_and_finished() -> None:
    program = """
        !a. !b. !w.
        +!a <: done <- !c.
        +!c <- .wait(10000).
        +!b <- .wait(10000).
        +!w <- .wait(10); .succeed_goal(b); +done.
        ^!a[state(S)] : .member(S, [achieved, finished]) <- .print(a, S).
        ^!b[state(S)] : .member(S, [achieved, finished]) <- .print(b, S).
        ^!c[state(S)] : .member(S, [dropped, finished]) <- .print(c, S).
        """
    assert printed(program) == ["bachieved", "bfinished", "cdropped", "cfinished", "aachieved", "afinished"]


def test_programs_see_the_annotations_of_labels() -> None:
    assert printed(
        """
        !s.
        @greet[cost(2), polite] +!greet.
        +!s
          <- .plan_label(P, greet[cost(C)]); .print(C);
             .findall(L, .plan_label(_, L[polite]), Ls); .length(Ls, N); .print(N);
             .relevant_plans({+!greet}, _, [M]); if (greet[source(self)] = M) { .print(own) };
             .add_plan({ @told +!h }, bob); if (.plan_label(_, told[source(S)])) { .print(S) }.
        """
    ) == ["2", "1", "own", "bob"]


def test_variables_inside_a_negation_or_a_collection_stay_free() -> None:
    assert printed(
        """
        !g. p(1). p(2).
        +!g <- ?(not q(Z)); Z = 3; .findall(X, p(X), [1,2]); X = 5; ?(true & .findall(Y, p(Y), L)); Y = 6; .count(p(W), 2);
          W = 7; .print(Z, X, Y, L, W).
        """
    ) == ["356[1,2]7"]


def test_an_atomic_intention_handles_its_own_failure_events() -> None:
    assert printed(
        """
        !a.
        @l[atomic] +!a <- .wait({+x}, 100); .print(no).
        -!a[error(E)] <- .print(E); !b.
        @m[atomic] +!b <- !h; .print(after).
        +!h <- .fail_goal(h); .print(no).
        -!h <- .print(handled).
        """
    ) == ["wait_timeout", "handled", "after"]


def test_a_wait_for_a_failure_event_sees_it_though_nothing_else_runs() -> None:
    assert printed("!g. !k. +!g <- .wait({-!n}); .print(seen). +!k <- .wait(10); !n. -!n <- .print(h).") == [
        "h",
        "seen",
    ]


def test_the_plan_of_a_suspended_goal_is_chosen_when_it_is_resumed() -> None:
    assert printed(
        """
        !g. !k. c(1).
        +!g <- !sub; .print(g2).
        +!sub : c(X) <- .print(sub(X)).
        +!k <- .suspend(g); -+c(2); .print(changed); .resume(g).
        """
    ) == ["changed", "sub(2)", "g2"]


def test_an_internal_action_that_cannot_be_done_does_not_hold_as_a_condition() -> None:
    assert printed(
        """
        !g. !h. r(X) :- .nth(5,[1],X). r(7).
        +!g : .nth(5,[1],X) <- .print(bad).
        +!g <- if (.nth(5,[1],X)) { .print(bad) } else { .print(no) };
          ?r(Y); .print(Y); .findall(Z, .nth(5,[1],Z), L); .print(L).
        +!h <- .nth(5,[1],_).
        -!h[error(E)] <- .print(E).
        """
    ) == ["no", "internal_action", "7", "[]"]


def test_a_belief_change_without_plan_takes_its_turn_in_the_event_queue() -> None:
    assert printed(
        """
        !g1. !g2. !g3.
        +!g1 <- +b; .print(a1); .print(a2).
        +!g2 <- .print(b1); .print(b2).
        +!g3 <- .print(c1); .print(c2).
        """
    ) == ["b1", "b2", "c1", "a1", "c2", "a2"]


def test_replacing_a_belief_with_annotations_replaces_one_that_has_them() -> None:
    assert printed(
        """
        !g. p(1). p(2)[foo].
        +!g <- -+p(9)[foo]; .findall(X, p(X), L); .print(L).
        -p(X)[|R] <- .print(del(X,R)).
        """
    ) == ["del(2,[foo,source(self)])", "[9,1]"]


def test_beliefs_with_very_long_lists_are_found_counted_once_and_deleted() -> None:
    assert printed(
        """
        !g.
        +!g <- .findall(X,.range(X,1,5000),L); .findall(X,.range(X,1,5000),M);
          +l(L); +l(M); .count(l(_),N); if (l(M)) { .print(held) }; -l(L); .count(l(_),K);
          if (k(L) == k(M)) { .print(equal) };
          .print(N, K).
        +l(_) <- .print(event).
        """
    ) == ["event", "held", "equal", "10"]


def test_a_negated_variable_stands_for_negated_literals_only() -> None:
    assert printed(
        """
        !g. ~p(1). p(2).
        +!g <- Y = ~p(3); ~Z = Y; .print(Z); .findall(W, ~W, L); .print(L);
          if (~V = p(3)) { .print(bad) }; !h(~p(5)); !h(p(5)).
        +!h(~X) <- .print(X).
        -!h(_) <- .print(no).
        """
    ) == ["p(3)", "[p(1)[source(self)]]", "p(5)", "no"]


def test_an_unbound_namespace_takes_every_namespace_in_turn() -> None:
    lines = printed("!g. a::p(1). b::p(3). p(4). +!g <- for (N::p(X)) { .print(N, X) }.")
    assert sorted(lines) == ["a1", "b3", "default4"]


def test_what_a_wait_for_an_event_binds_outlives_the_search_for_its_plan() -> None:
    lines = printed(
        """
        !g. !k.
        +!g <- .wait({+b(X)}); .print(X).
        +!k <- .wait(5); +b(1); .print(k).
        +b(X) : X > 5 <- .print(no).
        +b(X) : X > 4 <- .print(no).
        """
    )
    assert lines == ["1", "k"]


def test_done_ends_the_goal_at_once() -> None:
    assert printed("!g. +!g <- !h; .print(after). +!h <- .print(h1); .done; .print(no).") == ["h1", "after"]


def test_an_intention_whose_wait_ended_while_suspended_is_ready_at_its_resume() -> None:
    assert printed(
        """
        !g. !k.
        +!g <- .wait(10); .print(g2).
        +!k <- .wait(5); .suspend(g); .wait(20); .resume(g); .print(resumed); .print(r2).
        """
    ) == ["g2", "resumed", "r2"]


def test_goal_state_events_keep_their_order_and_tell_the_reason() -> None:
    assert printed(
        """
        !g.
        +!g <- !h; .wait(5); .print(end).
        +!h <- .fail.
        -!h.
        ^!h[state(S)[reason(R)]] <- .print(S, " ", R).
        """
    ) == ["pending ", "executing ", "failed ia_failed", "executing has_failure_plan", "finished ", "end"]


def test_a_goal_can_be_failed_before_it_is_taken_up() -> None:
    assert printed(
        """
        !g. !k. !x. !x. !x.
        +!g <- !h(1); .print(after).
        +!k <- .fail_goal(h(_)); .print(k).
        +!h(_) <- .print(no).
        -!h(X) <- .print(failh(X)).
        +!x.
        """
    ) == ["k", "failh(1)", "after"]


def test_goals_of_a_dropped_intention_are_no_desires() -> None:
    assert printed(
        """
        !g. !k. !x. !x. !x.
        +!g <- !h(1).
        +!k <- .drop_intention(g); if (.desire(h(_))) { .print(bad) } else { .print(gone) }.
        +!h(_). +!x.
        """
    ) == ["gone"]


def test_the_stack_of_an_intention_tells_its_goal_and_what_is_left_to_do() -> None:
    assert printed(
        """
        !g(1).
        +!g(X) <- .intention(_, running, [im(_, { +!g(Y) }, { _; B }, _)|_], current); .print(Y); .print(B); .wait(X).
        """
    ) == ["1", "{ .print(Y); .print(B); .wait(1) }"]


def test_terms_that_are_no_goals_or_bodies_fail_with_the_reason() -> None:
    assert printed(
        """
        !s.
        +!s <- !t({ +!a }); !t(7); !t("a"); !u({ .print(a) }); !u(3); Y = h(3)[q]; !Y[k].
        +!t(X) <- X.
        +!u(X) <- !X.
        -!t(_)[error(E)] <- .print(t, " ", E).
        -!u(_)[error(E)] <- .print(u, " ", E).
        +!h(N)[|R] <- .print(N, R).
        """
    ) == [
        "t body_var_not_literal",
        "t body_var_not_literal",
        "t body_var_not_literal",
        "u body_var_with_op",
        "u body_var_not_literal",
        "3[k,q,source(self)]",
    ]


def test_after_an_atomic_plan_its_intention_makes_one_more_step_before_the_others() -> None:
    assert printed(
        """
        !a. !b.
        +!a <- .print(a0); !s; .print(a1); .print(a2).
        @l[atomic] +!s <- .print(s1); .print(s2).
        +!b <- .print(b1); .print(b2); .print(b3).
        """
    ) == ["a0", "s1", "s2", "a1", "b1", "a2", "b2", "b3"]


def test_a_body_held_by_a_variable_makes_its_first_step_in_the_same_turn() -> None:
    assert printed(
        """
        !a. !b.
        +!a <- B = {.print(a1); .print(a2)}; B; .print(a3).
        +!b <- .print(b1); .print(b2); .print(b3); .print(b4); .print(b5).
        """
    ) == ["a1", "b1", "a2", "b2", "a3", "b3", "b4", "b5"]


def test_done_ends_a_handler_or_a_belief_plan_and_its_caller_goes_on() -> None:
    assert printed("!s. +!s <- !g; .print(after). +!g <- .fail. -!g <- .done; .print(no).") == ["after"]
    assert printed("!g. +!g <- +b; .print(x). +b <- .print(b); .done; .print(no).") == ["b", "x"]


def test_the_first_free_variable_is_given_back_between_the_rounds_of_a_loop() -> None:
    assert printed(
        """
        !t. c(0).
        +!t <- !h(X); .print(X); !k(Y); .print(Y).
        +!h(X) <- for (.range(I,1,2)) { .print(I); X = I }; .print(X).
        +!k(X) <- while (c(N) & N < 2) { -+c(N+1); X = N; .print(X) }; .print(X).
        """
    ) == ["1", "2", "X<no-value>", "X<no-value>", "0", "1", "Y<no-value>", "Y<no-value>"]


def test_beliefs_may_change_while_a_loop_goes_over_them() -> None:
    assert printed(
        """
        !g. p(1). p(2). p(3). p(4). p(5). ok. r(X) :- p(X) & ok.
        +!g <- for (r(X)) { .print(X); if (X == 1) { -ok } }; for (p(X)) { .print(X); -p(X+2) }; .print(end).
        """
    ) == ["1", "1", "2", "4", "5", "end"]


def test_a_goal_that_is_not_achieved_by_its_deadline_fails() -> None:
    assert printed(
        """
        !g.
        +!g <- !h[hard_deadline(50)]; .print(after); !!k[hard_deadline(50)]; !quick[hard_deadline(50)]; .wait(200);
          .print(end).
        +!h <- .wait(200); .print(no).
        -!h[error(E)] <- .print(E).
        +!k <- !h2.
        +!h2 <- .wait(200); .print(no).
        -!k[error(E)] <- .print(k, " ", E).
        +!quick <- .print(quick).
        """
    ) == ["deadline_reached", "after", "quick", "k deadline_reached", "end"]


def test_a_formula_without_value_fails_with_its_reason() -> None:
    assert printed("!g. +!g <- X = 1 div 0. -!g[error(E),code(C)] <- .print(E, " + '" ", C' + ").") == [
        "arithmetic_error (X = (1 div 0))"
    ]


def test_a_plan_goes_when_its_last_source_takes_it_back() -> None:
    assert printed(
        """
        !g.
        +!g <- .add_plan({@k +!a <- .print(1)}, bob); .add_plan({@k +!a <- .print(1)}, carl); .remove_plan(k, bob); !a;
          .remove_plan(k, carl); !a.
        -!g[error(E)] <- .print(E).
        """
    ) == ["1", "no_relevant"]


@pytest.mark.whole_stack
def test_plans_of_any_width_are_compiled() -> None:
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


def test_what_a_loop_binds_is_gone_after_it_and_in_its_next_round() -> None:
    assert printed("!g. +!g <- for (.member(Z,[W,[3]])) { .print(Z,W); W = f(b) }.")[1] == "[3]W<no-value>"
    assert printed("!g. p(1). +!g <- for (p(Z)) { Y = Z }; if (p(2)) { Y = 3 }; .print(Y).") == [
        "Y<no-value>"
    ]
    assert printed("!g. p(1). +!g <- if (p(2)) { Y = 2 } else { for (p(Z)) { Y = Z } }; .print(Y).") == [
        "Y<no-value>"
    ]
    assert printed("!g. +!g <- for (.member(X,[1,2])) { if (X == 1) { Y = one }; .print(Y) }.") == [
        "one",
        "Y<no-value>",
    ]


def test_a_body_held_by_a_variable_may_fail_at_once_and_gives_shared_variables_back() -> None:
    assert printed("!g. +!g <- B = {.fail}; B. -!g[error(E)] <- .print(E).") == ["ia_failed"]
    assert printed("!g. s(1). +!g <- B = {for (s(X)) {.print(X)}}; B; .print(X).") == ["1", "X<no-value>"]


def test_events_of_another_intention_share_no_variables() -> None:
    assert (
        printed("!g. +!g <- ++b(X); .print(a); .print(c); X = 7; .print(X). +b(Y) <- Y = 3; .print(b(Y)).")[
            -1
        ]
        == "7"
    )


def test_annotations_of_a_rule_head_have_the_values_of_the_answer() -> None:
    assert printed(
        "!g. p(1). p(2). hd(X)[k(X)] :- p(X). +!g <- .findall(K,hd(_)[k(K)],L); .print(L); ?hd(Y)[|R]; .print(Y, R)."
    ) == ["[1,2]", "1[k(1),source(self)]"]


def test_ending_a_goal_of_a_suspended_intention_lets_its_caller_go_on_at_once() -> None:
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


def test_a_tail_call_out_of_an_atomic_plan_ends_its_privilege() -> None:
    assert printed(
        """
        !a(2). !b.
        @l[atomic] +!a(N) : N > 0 <- .print(N); !a(N-1).
        +!a(0) <- .print(z1); .print(z2); .print(z3); .print(z4).
        +!b <- .print(b1); .print(b2); .print(b3).
        """
    ) == ["2", "1", "z1", "z2", "b1", "z3", "b2", "z4", "b3"]


def test_dropping_all_intentions_gives_up_the_planned_events() -> None:
    assert printed(
        """
        !s.
        +!s <- .at("now +1 s", {+!late}); .at("now", {+!now}); .wait(10); .drop_all_intentions;
               .at("now +1 s", {+!later}); .wait(3000); .print(end).
        +!late <- .print(late).
        +!now <- .print(now).
        +!later <- .print(later).
        """
    ) == ["now", "later", "end"]


def test_every_failure_of_a_step_has_a_message_for_people() -> None:
    lines = printed(
        """
        !s.
        +!s <- for (.member(G, [nobody, empty, number, body])) { !!try(G) }.
        +!try(G) <- !G.
        -!try(G)[error(E), error_msg(M)] <- .length(M, N); .print(G, " ", E, " ", N > 5).
        +!nobody <- .send(ghost, tell, p).
        +!empty <- !X.
        +!number <- X = 5; +X.
        +!body <- X = { a; b }; +X.
        """
    )
    assert [line.split()[:2] for line in lines] == [
        ["nobody", "receiver_not_found"],
        ["empty", "body_var_without_value"],
        ["number", "body_var_not_literal"],
        ["body", "body_var_with_op"],
    ]


def test_a_goal_in_a_variable_has_a_deadline_too() -> None:
    assert printed(
        """
        !a. !b.
        +!a <- G = slow; !G[hard_deadline(100)].
        -!a[error(E)] <- .print(a, E).
        +!b <- G = late[hard_deadline(50)]; !!G.
        +!slow <- .wait(10000).
        +!late <- .wait(10000).
        -!late[error(E)] <- .print(late, E).
        """
    ) == ["latedeadline_reached", "adeadline_reached"]


def test_an_atomic_intention_finds_its_own_event_behind_others() -> None:
    host = mind("+!a <- .wait(10). +!b.")
    host.agent.post_goal(atom("a"))
    host.agent.run(10)
    (intention,) = host.agent.alive.values()
    host.agent.post_goal(atom("b"))
    assert event_of(host.agent, intention) is None
    own = ((trigger("+", "!", functor("b", 0)),), intention, BY_SELF, None)
    host.agent.events.append(own)
    assert event_of(host.agent, intention) is None  # it waits for something else
    intention.waiting = None
    assert event_of(host.agent, intention) is own
    host.agent.intentions.append(intention)
    assert is_ready(host.agent, intention)
    assert event_of(host.agent, intention) is None


def test_an_atomic_intention_goes_on_wherever_it_stands() -> None:
    plans = "@a[atomic] +!a <- !b; .print(a). +!b <- !c; .print(b). @c[atomic] +!c <- .print(c). +!d(X) <- .print(X)."
    goals = [*(f"!d({number})." for number in range(3)), "!a.", *(f"!d({number})." for number in range(3, 6))]
    lines = printed(" ".join([*goals, plans]))
    assert "".join(lines).count("cba") == 1
