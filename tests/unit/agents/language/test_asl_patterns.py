"""Patterns of plans: what they expand to, and how the plans run."""

from asl_lab import belief_texts, places, plan_texts
from asl_lab import program as program_of
from recording_host import printed, programs

from jacaros.agents.language import nodes


def expanded(pattern: str, clauses: str = "+!at(X) : a(X) <- go(X).") -> list[str]:
    return plan_texts(f"{{ begin {pattern} }} {clauses} {{ end }}")


BELIEVED = "+!at(_1) : at(_1)."
TESTED = "+!at(X) : a(X) <- go(X); ?at(X)."
SUCCEEDS = "+at(_1) <- .succeed_goal(at(_1))."
RETRY = "-!at(_1) <- !at(_1)."
LAST = "+!at(_1) <- !at(_1)."


def test_declarative_and_backtracking_goals():
    assert expanded("dg(at(_))") == [BELIEVED, TESTED, SUCCEEDS]
    assert expanded("bdg(at(_))") == [BELIEVED, TESTED, SUCCEEDS, RETRY]


def test_only_plans_for_the_goal_are_changed_in_one_variable():
    assert expanded("dg(at(_))", "+!at(X,Y) <- b. +!other <- b. -!at(X) <- b.")[1:-1] == [
        "+!at(X,Y) <- b.",
        "+!other <- b.",
        "-!at(X) <- b; ?at(X).",
    ]
    assert expanded("dg(at(home))", "+!at(work) <- b. +!at(Y) <- b. -!P <- b.")[1:-1] == [
        "+!at(work) <- b.",
        "+!at(Y) <- b; ?at(Y).",
        "-!P <- b.",
    ]
    plan = program_of("{ begin dg(at(_)) } { end }").plans[0]
    assert isinstance(plan.trigger.literal, nodes.Literal)
    assert plan.trigger.literal == plan.context
    assert all(isinstance(a, nodes.Variable) and not a.unnamed for a in plan.trigger.literal.arguments)


def test_an_exclusive_goal_tries_each_plan_once():
    plans = expanded("ebdg(at(_))", "+!at(X) : a(X) <- go(X). +!at(X) <- fly(X).")
    assert plans[1].startswith(
        "+!at(X) : not (p__tried(0,at(X))) & a(X) <- +p__tried(0,at(X)); go(X); ?at(X)"
    )
    assert plans[2].startswith("+!at(X) : not (p__tried(1,at(X))) <- +p__tried(1,at(X)); fly(X); ?at(X)")
    assert plans[-2].startswith("-!at(_1)[error(no_applicable)] <- .abolish(p__tried(")
    assert plans[-1] == RETRY


def test_commitments_end_with_success_failure_or_motivation():
    assert expanded("bc(at(_))") == [BELIEVED, TESTED, SUCCEEDS, RETRY, LAST]
    assert expanded("bc(at(_),dg)") == [BELIEVED, TESTED, SUCCEEDS, LAST]
    assert expanded("smc(at(_), broken)") == [
        BELIEVED,
        TESTED,
        SUCCEEDS,
        "-!at(_1) : not (broken) <- !at(_1).",
        "+!at(_1) : not (broken) <- !at(_1).",
        '-!at(_1) <- .fail(error(impossible),error_msg("the goal is believed to be impossible")).',
        "+broken <- .fail_goal(at(_1)).",
    ]
    ended = "-wanted <- .succeed_goal(at(_1))."
    assert expanded("rc(at(_), wanted)") == [BELIEVED, TESTED, SUCCEEDS, RETRY, LAST, ended]
    plans = expanded("omc(at(_), broken, wanted)")
    assert plans[-2:] == ["+broken <- .fail_goal(at(_1)).", ended]


def test_a_maintenance_goal_is_believed_at_first_and_pursued_when_lost():
    text = "{ begin mg(charged) } +!charged <- charge. { end }"
    assert belief_texts(text) == ["charged"]
    committed = plan_texts("{ begin bc(charged) } +!charged <- charge. { end }")
    assert plan_texts(text) == [*committed, "-charged <- !charged."]
    single_minded = plan_texts("{ begin smc(charged, broken) } +!charged <- charge. { end }")
    text = "{ begin mg(charged, smc(charged, broken)) } +!charged <- charge. { end }"
    assert plan_texts(text) == [*single_minded, "-charged <- !charged."]
    assert belief_texts("{ begin mg(level(X)) } { end }") == []
    assert "?charged" in plan_texts("{ begin mg(charged, bdg) } +!charged <- charge. { end }")[1]


def test_sequenced_goals_take_texts():
    text = expanded('sga("+order(X)", "open & ok(X)", serve(X))', "")
    assert text[0] == (
        "@p__sga1_begin[atomic] +order(X) : not (p__busy(1)) & (open & ok(X)) <- +p__busy(1); "
        "!!p__serve(1,serve(X))."
    )
    assert expanded('sga("+!order(X)", "true", serve(X))', "")[1] == (
        "@p__sga1_wait[atomic] +!order(X) <- +>p__queue(1,serve(X))."
    )


def test_patterns_respect_namespaces_and_can_be_nested():
    text = "{ begin namespace(m) } { begin dg(g) } +!g <- a. { end } { end }"
    assert plan_texts(text) == ["+!m::g : m::g.", "+!m::g <- a; ?m::g.", "+m::g <- .succeed_goal(m::g)."]
    plans = expanded('sga("+order", "true", home)', "{ begin bdg(home) } +!home <- go. { end }")
    assert plans[:4] == expanded("bdg(home)", "+!home <- go.")


def test_wrong_patterns_are_refused():
    def messages(pattern: str) -> list[tuple[int, str]]:
        return places(f"a.\n{{ begin {pattern} }}\n+!g <- a.\n{{ end }}")

    assert messages("dg(X)") == [(2, "argument 1 of `dg` (the goal) is not a literal")]
    assert messages("dg") == [(2, "`dg` expects the goal as argument 1")]
    assert messages("dg(a,b)") == [(2, "`dg` expects at most 1 argument, found 2")]
    assert messages("bc(g,foo)") == [(2, "unknown pattern `foo`")]
    assert messages("smc(g)") == [(2, "`smc` expects the belief that the goal is impossible as argument 2")]
    assert messages('sga("order", "true", g)')[0][1].startswith("`order` is not a trigger: ")
    assert messages('sga("+order", "a &", g)')[0][1].startswith("`a &` is not a condition: ")
    assert messages("foo(g)") == [(2, "unknown directive `foo` with a block")]
    assert messages("sga({+order}, true, g)")[0][1] == "argument 1 of `sga` is not a trigger"
    assert messages('sga("+order", true, g)')[0][1] == "`sga` expects a context as argument 2"


RUN = """
an exclusive goal fails when all its plans have been tried => first(tea) | second(tea) | no_applicable 0
    { begin ebdg(got(_)) }
    +!got(X) <- .print(first(X)); .fail.
    +!got(X) : false <- .print(never).
    +!got(X) <- .print(second(X)); .fail.
    { end }
    !start.
    +!start <- !got(tea); .print(bad).
    -!start[error(E)] <- .count(p__tried(_,_),N); .print(E," ",N); .stopMAS.
an exclusive goal continues with the next plan => first | second | 0
    { begin ebdg(got(_)) }
    +!got(X) <- .print(first); .fail.
    +!got(X) <- .print(second); +got(X).
    { end }
    !start.
    +!start <- !got(tea); .count(p__tried(_,_),N); .print(N); .stopMAS.
single minded commitment fails when the goal is impossible => try | try | try | breaking | failed(impossible)
    { begin smc(clean, broken) }
    +!clean <- .print(try); .wait(100); .fail.
    { end }
    !start. !breaker.
    +!start <- !clean; .print(bad).
    -!start[error(E)] <- .print(failed(E)); .stopMAS.
    +!breaker <- .wait(250); .print(breaking); +broken.
relativised commitment ends without its motivation => try | try | unwanted | over
    wanted.
    { begin rc(clean, wanted) }
    +!clean <- .print(try); .wait(100); .fail.
    { end }
    !start. !loser.
    +!start <- !clean; .print(over); .stopMAS.
    +!loser <- .wait(150); .print(unwanted); -wanted.
open minded commitment is also achieved => try(a) | over | try(b) | ended
    wanted.
    { begin omc(at(_), broken, wanted) }
    +!at(X) <- .print(try(X)); .wait(100); +at(X).
    { end }
    !start.
    +!start <- !at(a); .print(over); !!other; .wait(50); -wanted.
    +!other <- !at(b); .print(ended); .stopMAS.
sequenced goals queue up and a failing one makes room
=> begin(1) | placed | end(1) | fails | begin(3) | end(3) | begin(4) | end(4)
    { begin sga("+order(X)", "true", serve(X)) }
    { end }
    !start.
    +!start <- ++order(1); ++order(2); ++order(3); .print(placed); .wait(900); ++order(4); .wait(300); .stopMAS.
    +!serve(2) <- .print(fails); .fail.
    +!serve(X) <- .print(begin(X)); .wait(160); .print(end(X)).
"""


@programs(RUN)
def test_what_a_program_prints(program, output):
    assert printed(program) == output
