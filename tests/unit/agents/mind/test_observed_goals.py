"""Notifications of observers of goals: each goal begins once and ends once."""

from collections import Counter
from pathlib import Path
from random import Random

import pytest
from recording_host import mind

from jacaros.agents.mind.rules.clr_int import pending_event
from jacaros.agents.mind.rules.failure_reason import goal_text
from jacaros.agents.mind.rules.meta_events import failed_number, observe_goals
from jacaros.agents.mind.state.act import Act, Completion
from jacaros.agents.mind.state.intention import ANNOTATIONS, EVENT_ANNOTATIONS, EVENT_GOAL, GOAL, SERIAL
from jacaros.runtime.mas.history.goals import GoalRecords

CASES = Path(__file__).parents[3] / "conformance"
BEGUN = ("pursued", "suspended", "resumed")


def test_an_observer_is_notified_of_every_change_of_a_goal():
    host = mind("!a. +!a <- !b; .wait(10); .suspend(a); .print(x). +!b <- .fail. -!b.")
    heard: list[tuple[str, str]] = []
    observe_goals(
        host.agent, lambda state, goal, number, intention, why: heard.append((state, f"!{goal_text(goal)}"))
    )
    host.run()
    states = [state for state, goal in heard if goal == "!a"]
    assert states == ["executing", "waiting", "executing", "suspended"]
    assert [state for state, goal in heard if goal == "!b"] == [
        "executing",
        "failed",
        "executing",
        "recovered",
        "finished",
    ]


def goals_at_the_end(program):
    """The last text and state of each goal of a program, by number."""
    host, last = mind(program), {}
    news = GoalRecords(lambda goal: last.update({goal.id: f"{goal.state} {goal.goal}"}))
    observe_goals(host.agent, lambda *change: news("bob", *change))
    host.run()
    return list(last.values())


def test_goals_with_new_values_and_tail_calls_are_followed():
    assert goals_at_the_end("!a. +!a <- !ask(X). +!ask(X) <- X = 3.") == ["achieved !a", "achieved !ask(3)"]
    program = "!loop(1). +!loop(N) : N < 3 <- !loop(N + 1). +!loop(_)."
    assert goals_at_the_end(program) == ["replaced !loop(1)", "replaced !loop(2)", "achieved !loop(3)"]


def test_goals_fail_or_recover_by_their_failure_plans():
    program = "!try. +!try <- !inner. -!try. +!inner <- .fail."
    assert goals_at_the_end(program) == ["recovered !try", "failed !inner"]
    assert goals_at_the_end("!a. +!a <- !b(1). -!b(_) <- .wait(1).") == ["achieved !a", "recovered !b(1)"]
    assert goals_at_the_end("!b(1). -!b(_) <- .wait(1).") == ["recovered !b(1)"]
    program = "!a. +!a <- !b. -!b <- !c. +!c <- .fail."
    assert goals_at_the_end(program) == ["failed !a", "failed !b", "failed !c"]
    assert goals_at_the_end("!a. +!a <- .fail. -!a : false.") == ["failed !a"]


@pytest.mark.parametrize("step", [".wait(400)", ".suspend(tour(N))"])
def test_goals_that_failed_below_a_failure_plan_are_not_pursued_again(step):
    program = f"""
        !tour(1). +!tour(N) <- !visit(N). +!visit(N) <- !deep(N). +!deep(_) <- .wait(100); .fail.
        -!tour(N) <- {step}; .print(done).
        !other. +!other <- .wait(1000); .resume(tour(1)).
    """
    ends = goals_at_the_end(program)
    assert ends == ["recovered !tour(1)", "achieved !other", "failed !visit(1)", "failed !deep(1)"]


def test_the_goals_of_branches_end_with_them():
    program = "!a(1). +!a(N) <- !b(N) ||| !c(X); .wait(10). +!b(_) <- .wait(20). +!c(3) <- .wait(5)."
    assert goals_at_the_end(program) == ["achieved !a(1)", "dropped !b(1)", "achieved !c(3)"]
    program = "!a(1). +!a(N) <- !b(N) |&| !c(X); .wait(10). +!b(_) <- .wait(20). +!c(3) <- .wait(5)."
    assert goals_at_the_end(program) == ["achieved !a(1)", "achieved !b(1)", "achieved !c(3)"]
    program = "!a(1). +!a(N) <- !b(N) ||| !c(X). +!b(_) <- .wait(20). +!c(3) <- !d. +!d <- .fail."
    assert goals_at_the_end(program) == ["achieved !a(1)", "achieved !b(1)", "failed !c(3)", "failed !d"]
    program = "!a. +!a <- !b {} !c; .print(joined). +!b <- .fail. -!b : p. +!c <- .wait(10)."
    assert goals_at_the_end(program.format("|&|")) == ["failed !a", "failed !b", "dropped !c"]
    assert goals_at_the_end(program.format("|||")) == ["achieved !a", "failed !b", "achieved !c"]


def test_goals_ended_from_outside_end():
    program = "!a. +!a <- !b; .print(x). +!b <- !c. +!c <- .wait(1000). !k. +!k <- .wait(5); .{}."
    assert goals_at_the_end(program.format("drop_intention(a)"))[:2] == ["dropped !a", "achieved !k"]
    assert sorted(goals_at_the_end(program.format("fail_goal(b)"))) == [
        "achieved !k",
        "failed !a",
        "failed !b",
        "failed !c",
    ]
    assert sorted(goals_at_the_end(program.format("succeed_goal(b)"))) == [
        "achieved !a",
        "achieved !b",
        "achieved !k",
        "dropped !c",
    ]


class Watched:
    """A program with a watcher of its goals."""

    def __init__(self, program, **arguments):
        self.host = mind(program, **arguments)
        self._ends, self._last = Counter(), {}
        self._news = GoalRecords(self._hear)
        observe_goals(self.host.agent, lambda *change: self._news("bob", *change))

    def _hear(self, goal):
        number, state = goal.id, goal.state
        assert not self._ends[number], goal
        self._last[number] = state
        self._ends[number] += state not in (*BEGUN, "failed")

    def check(self):
        """Compare the goals that are open for the watcher with those on the stacks."""
        begun = {which for _, which in self._news._goals}
        agent = self.host.agent
        assert begun == {number for each in agent.alive.values() for number in pursued(agent, each)}
        assert len([state for state in self._last.values() if state in BEGUN]) == len(begun)


def pursued(agent, intention):
    """The numbers of the goals on a stack; a handler stands for the goal whose failure it deals with."""
    frames, handlers = list(intention.frames), list(intention.handlers)
    event = pending_event(agent, intention)
    if event is not None and event[EVENT_GOAL][0].failing:  # the handler is not on the stack yet
        frames.append([None, event[EVENT_GOAL], event[EVENT_ANNOTATIONS], 0])
    height = len(frames) - 1
    while height >= 0:
        frame = frames[height]
        if frame[GOAL][0].failing and handlers:
            height = handlers.pop()
            number = failed_number(frame[ANNOTATIONS])
            frame = frames[height]
            if number is not None and frame[GOAL][0].kind == "!":
                yield number
        if frame[GOAL][0].kind == "!" and not frame[GOAL][0].failing:
            yield frame[SERIAL]
        height -= 1


@pytest.mark.parametrize(
    "case", sorted(CASES.rglob("*.asl")), ids=lambda path: f"{path.parent.name}/{path.stem}"
)
def test_every_goal_ends_once_unless_it_is_still_pursued(case):
    if "syntax_errors" in case.parts or not case.with_suffix(".expected").exists():
        return
    watched = Watched(case.read_text(), name=case.stem, path=str(case), complete=no_environment)
    watched.host.run()
    watched.check()


def any_step(random):
    """A step of a plan: goals, actions that end later or fail, and what ends, suspends and resumes goals."""
    goal = random.choice("abcdef")
    argument = random.choice(("1", "2", "X", "_"))
    return random.choice(
        (
            *(f"!{goal}({argument})",) * 6,
            *(f"!!{goal}({argument})", f"{{ !{goal}(1) |&| !b(2) }}", f"{{ .wait(1) ||| !{goal}(2) }}"),
            *("act", ".wait(5)", ".wait(1)", ".fail", "X = 1", "+p(1)", "?p(X)", "!unknown", ".done"),
            *(f".drop_intention({goal}(_))", f".drop_desire({goal}(_))", f".succeed_goal({goal}(_))"),
            *(f".fail_goal({goal}(_))", f".suspend({goal}(_))", f".resume({goal}(_))"),
            *(f"for (.member(Y, [1, 2])) {{ !{goal}(Y) }}", f"!{goal}(1)[hard_deadline(3)]"),
        )
    )


def any_program(random):
    """A program of goals that fail, wait, fork, replace and end one another."""
    plans = []
    for goal in "abcdef":
        for _ in range(random.randint(1, 2)):
            context = random.choice(("true", "p(X)", "X < 2", "not p(2)"))
            body = "; ".join(any_step(random) for _ in range(random.randint(1, 4)))
            plans.append(f"{random.choice(('', '', '', '@[atomic] '))}+!{goal}(X) : {context} <- {body}.\n")
        if random.random() < 0.5:
            plans.append(f"-!{goal}(X) : {random.choice(('true', 'p(1)'))} <- {any_step(random)}.\n")
    handler = random.choice(("", "-!unknown <- .wait(2).\n", "-!unknown <- !a(1).\n"))
    return f"!a(1). !b(2).\n+!unknown : false.\n{handler}+p(X) <- {any_step(random)}.\n{''.join(plans)}"


@pytest.mark.parametrize("seed", range(100))
def test_every_goal_of_a_random_program_ends_once(seed):
    random = Random(seed)
    program = any_program(random)
    outcomes = iter([random.choice((Completion(True), Completion(False), None)) for _ in range(400)])
    watched = Watched(program, complete=lambda act: next(outcomes, None))
    host = watched.host
    for _ in range(300):
        if not host.agent.run(1) and not host.ring_next(host.time + 100):
            break
        watched.check()


def no_environment(act: Act) -> Completion:
    del act
    return Completion(success=False)
