"""Generated code that is kept from run to run: found again only by what would be compiled to the same."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import pytest
from recording_host import RecordingHost

from jacaros.asl.loader import load_program
from jacaros.bdi.actions.internal_action import STANDARD, InternalAction
from jacaros.bdi.engines import new_engine
from jacaros.bdi.fast.generated import unit
from jacaros.bdi.mind import Mind
from jacaros.bdi.state.plan_library import ProgramPlans

PROGRAM = """
at(1, 2)[source(camera)].
seen(box(1), [red, "wet", 2.5], _)[by(ann)].
near(X, Y) :- at(X, Z) & Y = Z + 1 | far(X, Y).
far(3, 4).
!all.

@all[atomic]
+!all
  <- !rules; !terms; !loops; !others; .send(self, tell, told(1)); .send(robot, tell, told(2));
     !!later; .my(X); .print(X); !sub(5).
+!rules : near(1, Y) & not near(2, _) & .findall(X, near(X, _), L) <- .print(Y, L).
+!terms : seen(box(N), [C | Rest], _)[by(Who)]
  <- X = f(~a, g::b, "text", [1, 2, 3 | Rest], -0.5)[x, y(2)]; .print(N, C, Who, X).
+!loops
  <- for (.range(I, 1, 2)) { +count(I) };
     while (count(I)) { -count(I); if (I == 1) { .print(one) } elif (I > 1) { .print(more) } else { .fail } };
     { .print(left) |&| .print(right) }.
+!others : math.max(1, 2) == 2 <- ?unknown(A); .print(A).
+?unknown(3).
+!later <- .fail.
-!later[error(E)] <- .print(E).
+told(N)[source(S)] <- .print(told, N, S).
+!G <- .print(G).
"""


class Memory(dict[bytes, bytes]):
    """Keeps entries in memory."""

    def put(self, key: bytes, entry: bytes) -> None:
        self[key] = entry


def run(
    memory: Memory | None,
    program: str = PROGRAM,
    actions: Mapping[str, InternalAction] | None = None,
    name: str = "robot.asl",
) -> list[str]:
    """What an agent prints that compiles all plans before it begins."""
    tree, _ = load_program(name, program)
    host = RecordingHost(None)
    known = {
        **STANDARD,
        **(actions or {".my": InternalAction(".my", lambda ctx, value: ctx.unify(value, 7.0))}),
    }
    plans = ProgramPlans(tree.plans, new_engine(known, plain=False, cache=memory))
    while plans.engine.compile_ahead(plans):
        pass
    host.agent = Mind("robot", tree, host, actions=known, plans=plans)
    host.agent.start()
    host.run()
    return host.printed


@pytest.fixture
def compiled(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The names of the files of all units that are compiled."""
    files: list[str] = []
    real: Callable[..., object] = unit.compile_all

    def compile_all(writers: Sequence[object], filename: str) -> object:
        files.append(filename)
        return real(writers, filename)

    monkeypatch.setattr(unit, "compile_all", compile_all)
    return files


def test_a_second_start_compiles_nothing_and_prints_the_same(compiled: list[str]) -> None:
    memory = Memory()
    without, first = run(None), run(memory)
    assert len(first) > 10
    compiled.clear()
    assert (run(memory), compiled) == (first, [])
    assert without == first


def test_without_a_cache_every_start_compiles(compiled: list[str]) -> None:
    run(None)
    once = len(compiled)
    run(None)
    assert len(compiled) == 2 * once > 0


@pytest.mark.parametrize(
    "program",
    [
        "+!go <- .print(1).",
        "+!go <- .print(1.5).",
        '+!go <- .print("1").',
        "+!go <- .print(a).",
        "+!go <- .print(A).",
        "+!go <- .print(a, []).",
        "+!go <- .print(a(b)).",
        "+!go <- .print([a, b]).",
        "+!go <- .print([a | [b]]).",
        "+!go <- .print(~a).",
        "+!go <- .print(a[b]).",
        "+!go <- .print(x::a).",
        "\n+!go <- .print(1).",
        "+!go\n<- .print(1).",
        "+!go : true <- .print(1).",
        "+!go : not true <- .print(1).",
        "@all[all_unifs] +!go <- .print(1).",
        "+!go <- .print(1); .print(1).",
        "+!go <- .println(1).",
        "+!go[x] <- .print(1).",
    ],
)
def test_any_difference_in_a_program_makes_it_compile(program: str, compiled: list[str]) -> None:
    memory = Memory()
    for other in ("+!go <- .print(2).", "+!go(1) <- .print(1).", "-!go <- .print(1).", "+!go <- .print(x)."):
        run(memory, other)
    compiled.clear()
    run(memory, program)
    assert len(compiled) == 1
    run(memory, program)
    assert len(compiled) == 1


def test_code_of_another_file_is_not_taken(compiled: list[str]) -> None:
    memory = Memory()
    run(memory, "+!go.", name="one.asl")
    run(memory, "+!go.", name="two.asl")
    assert compiled == ["one.asl", "two.asl"]


MINE = "!go. +!go <- .print(before); .my(1, X); .print(X)."


def mine(value: float, **changes: object) -> dict[str, InternalAction]:
    action = InternalAction(".my", lambda ctx, first, result: ctx.unify(result, value), arity=2)
    return {".my": replace(action, **changes)}  # type: ignore[arg-type]


def test_code_that_is_kept_calls_the_action_of_this_run(compiled: list[str]) -> None:
    memory = Memory()
    assert run(memory, MINE, mine(5.0)) == ["before", "5"]
    compiled.clear()
    assert (run(memory, MINE, mine(6.0)), compiled) == (["before", "6"], [])


@pytest.mark.parametrize(
    "changes", [{"suspends": True}, {"arity": 3}, {"backtracks": True}, {"by_name": True}, {"collects": True}]
)
def test_an_action_that_is_declared_in_another_way_is_compiled_anew(
    changes: dict[str, object], compiled: list[str]
) -> None:
    memory = Memory()
    program = "+!go <- .print(before); .my(1, X); .print(X)."
    run(memory, program, mine(5.0))
    compiled.clear()
    run(memory, program, mine(5.0, **changes))
    assert compiled == ["robot.asl"]


def test_an_action_that_is_missing_later_is_compiled_anew(compiled: list[str]) -> None:
    memory = Memory()
    run(memory, "+!go <- .my(1, X).", mine(5.0))
    compiled.clear()
    run(memory, "+!go <- .my(1, X).", {".other": InternalAction(".other")})
    assert compiled == ["robot.asl"]


def test_two_actions_that_become_one_function_are_compiled_anew(compiled: list[str]) -> None:
    def one(ctx: object, *arguments: object) -> None:
        del ctx, arguments

    def two(ctx: object, *arguments: object) -> None:
        del ctx, arguments

    memory, program = Memory(), "+!go <- .one(1); .two(1)."
    run(memory, program, {".one": InternalAction(".one", one), ".two": InternalAction(".two", one)})
    compiled.clear()
    run(memory, program, {".one": InternalAction(".one", one), ".two": InternalAction(".two", two)})
    assert compiled == ["robot.asl"]


def test_plans_that_come_at_run_time_are_not_kept() -> None:
    memory = Memory()
    run(memory, "!go. +!go <- .print(1).")
    before = len(memory)
    run(memory, "!go. +!go <- .print(1). +!more <- .add_plan({ +!new(N) <- .print(N) }); !new(2).")
    run(memory, "!more. +!go <- .print(1). +!more <- .add_plan({ +!new(N) <- .print(N) }); !new(2).")
    assert len(memory) == before + 1


def test_steps_of_kept_code_know_their_formulae() -> None:
    memory = Memory()
    program = (
        "!go. +!go\n <- .print(a);\n ?no(1).\n-!go[code(C), code_line(L), code_src(S)] <- .print(C, L, S)."
    )
    assert run(memory, program) == run(memory, program) == ["a", "no(1)3file:robot.asl"]


def test_a_plan_too_large_to_be_compiled_is_not_kept() -> None:
    steps = "; ".join(f"X{i} = {i}; +b(X{i})" for i in range(300))
    memory = Memory()
    assert run(memory, f"!go. +!go <- {steps}; .print(end).") == ["end"]
