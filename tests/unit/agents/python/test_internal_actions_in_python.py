"""Internal actions that a project writes in Python."""

import pytest
from extension_lab import HEAD, assert_output, run, said, write
from recording_host import programs

from jacaros.testing import run_project

EXTENDED = """
a function is called and its value is the last argument => 5 | yes | ia_failed
    @internal_action("my.norm")
    def anything(x: float, y: float) -> float:
        return (x * x + y * y) ** 0.5
    ---
    !go. +!go <- my.norm(3, 4, L); .print(L); my.norm(3, 4, 5); .print(yes); my.norm(3, 4, 6); .print(no).
    -!go[error(E)] <- .print(E).
the default name is module and function => 12
    @internal_action
    def one(x: Out) -> None:
        x.set(1)

    @internal_action()
    def two(x: Out) -> None:
        x.set(2)
    ---
    !go. +!go <- my.one(X); my.two(Y); .print(X, Y).
a function that declares a value and has none fails => [4,6]
    @internal_action
    def find(x: int) -> int | None:
        return x if x > 3 else None
    ---
    !go. +!go <- .findall(Y, .member(X, [2,4,6]) & my.find(X, Y), L); .print(L).
arguments arrive as Python values
=> (1, 1.5, 's', Atom('a'), [1, Atom('b')], Structure(functor='p', arguments=(1, [Atom('x')])), True)
    @internal_action
    def show(*values) -> str:
        return repr(values)
    ---
    !go. +!go <- my.show(1, 1.5, "s", a, [1,b], p(1,[x]), true, S); .print(S).
an unbound variable is a place for a result => 1at(2)
    @internal_action
    def fill(pair):
        first, second = pair.arguments
        first.set(1)
        second.set(Structure("at", (2,)))
    ---
    !go. +!go <- my.fill(pair(X, Y)); .print(X, Y).
the parts of a literal are available => ["bob"]
    @internal_action
    def who(belief: Literal) -> list[str]:
        return sorted(belief.sources)
    ---
    b(1)[source(bob)]. !go. +!go : b(X)[source(S)] <- my.who(b(X)[source(S), q], L); .print(L).
a generator gives its answers in turn => 7 | [0,2,4] | [p(0,2),p(2,0)] | 0 | 1 | 3
    @internal_action
    def each(n: int) -> Iterator[int]:
        yield from range(n)

    @internal_action
    def split(n: int, left: Out, right: Out) -> Iterator[None]:
        for part in range(n + 1):
            left.set(part)
            right.set(n - part)
            yield
    ---
    even(X) :- my.each(5, X) & X mod 2 == 0.
    !go.
    +!go : my.each(9, X) & X > 6
      <- .print(X); .findall(Y, even(Y), L); .print(L);
         .findall(p(A,B), my.split(2, A, B) & A \\== 1, M); .print(M);
         for (my.each(2, Z)) { .print(Z) };
         my.split(4, C, 1); .print(C).
an endless generator is asked only for what is needed => 8
    import itertools

    @internal_action
    def naturals() -> Iterator[int]:
        yield from itertools.count()
    ---
    !go. +!go : my.naturals(X) & X * X > 50 <- .print(X).
a coroutine suspends only its intention => one | t at 5 | six
    import asyncio

    @internal_action
    async def fetch(agent: Agent, seconds: float) -> str:
        await asyncio.sleep(seconds)
        return f"{agent.name} at {agent.now() % 60:g}"
    ---
    !a. !b.
    +!a <- my.fetch(5, R); .print(R).
    +!b <- .wait(1000); .print(one); .wait(5000); .print(six).
a coroutine can wait for a thread => 499500 | later
    import asyncio

    @internal_action
    async def work(n: int) -> int:
        return await asyncio.to_thread(lambda: sum(range(n)))
    ---
    !a. !b. +!a <- my.work(1000, X); .print(X). +!b <- .wait(60000); .print(later).
a coroutine that fails fails its step
=> 3 | 4 ia_failed internal action my.odd failed | 7 internal_action too large 5
    import asyncio

    @internal_action
    async def odd(n: int) -> int | None:
        await asyncio.sleep(1)
        if n > 5:
            raise ActionError("too large", Structure("limit", (5,)))
        return n if n % 2 else None
    ---
    !go.
    +!go <- my.odd(3, X); .print(X); !g(4); !g(7).
    +!g(N) <- my.odd(N, X).
    -!g(N)[error(E), error_msg(M), limit(L)] <- .print(N, " ", E, " ", M, " ", L).
    -!g(N)[error(E), error_msg(M)] <- .print(N, " ", E, " ", M).
a suspended intention gets the result when it is resumed => 1at3
    import asyncio

    @internal_action
    async def nap() -> int:
        await asyncio.sleep(1)
        return 1
    ---
    !a. !b. +!a <- my.nap(X); .time(H,M,S); .print(X, at, S). +!b <- .suspend(a); .wait(3000); .resume(a).
an argument of another kind is wrong => wrong_arguments my.half: argument 1 (x): expected a number, found a
    @internal_action
    def half(x: float) -> float:
        return x / 2
    ---
    !go. +!go <- my.half(a, X). -!go[error(E), error_msg(M)] <- .print(E, " ", M).
a wrong number of arguments is wrong => 4.5 3 | my.half expects 2 to 3 arguments, found 1
    @internal_action
    def half(x: float, by: float = 2) -> float:
        return x / by
    ---
    // jacaros: ignore-file wrong-arguments
    !go. +!go <- my.half(9, X); my.half(9, 3, Y); .print(X, " ", Y); my.half(1). -!go[error_msg(M)] <- .print(M).
the calling agent is available => once kitchen | 1
    @internal_action
    def remember(agent: Agent, place: str) -> None:
        for answer in agent.ask("seen(X)"):
            agent.remove_belief(Literal("seen", (answer["X"],)))
        agent.add_belief(Literal("seen", (place,)))
        agent.achieve("tell(once)")

    @internal_action
    def none():
        return False
    ---
    seen(nothing).
    !go.
    +!go <- my.remember(kitchen).
    +seen(X) : my.none <- .print(X).
    +!tell(How) : seen(X) <- .print(How, " ", X); .count(seen(_), N); .print(N).
a function without value succeeds unless it returns false => yes | yes | ia_failed
    @internal_action
    def test(x):
        return [None, True, False][x]
    ---
    !go(0). !go(1). !go(2). +!go(N) <- my.test(N); .print(yes). -!go(_)[error(E)] <- .print(E).
a value that is not declared is reported => internal_action | ! write 'def sum(...) -> int'
    @internal_action
    def sum(x, y):
        return x + y
    ---
    !go. +!go <- my.sum(1, 2). -!go[error(E)] <- .print(E).
an exception in a condition is reported with its line => yes | ! my.py:5
    @internal_action
    def bad():
        raise ValueError("no")
    ---
    !go. +!go : my.bad <- .print(no). +!go <- .print(yes).
an exception fails only the step and is logged with its line
=> internal_action 2 | other | ! [t] error: my.bad: ZeroDivisionError: division by zero (FOLDER/my.py:5)
    @internal_action
    def bad(x):
        return 1 / x
    ---
    !go. !other.
    +!go <- my.bad(0).
    -!go[error(E), error_msg("my.bad: ZeroDivisionError: division by zero (FOLDER/my.py:5)"), code_line(L)]
      <- .print(E, " ", L).
    +!other <- .wait(10); .print(other).
a coroutine cannot be a condition
=> other | ! t.asl:1:13: warning: `my.fetch` acts or takes time and never holds as a condition | ! and cannot be a condition
    @internal_action
    async def fetch(x: int) -> int:
        return x
    ---
    !go. +!go : my.fetch(1, X) <- .print(X). +!go <- .print(other).
a result that contains itself fails the step => a: internal_action | b: internal_action | ! my.now: Rec | ! my.later: Rec
    def endless():
        found = []
        found.append(found)
        return found

    @internal_action
    def now() -> list:
        return endless()

    @internal_action
    async def later() -> list:
        return endless()
    ---
    !a. !b.
    +!a <- my.now(X). -!a[error(E)] <- .print("a: ", E).
    +!b <- my.later(X). -!b[error(E)] <- .print("b: ", E).
"""


@programs(EXTENDED)
def test_what_a_program_prints(tmp_path, program, output):
    assert_output(tmp_path, program, output)


def test_dropping_the_intention_cancels_its_coroutine(tmp_path):
    python = """
import asyncio

@internal_action
async def long(agent: Agent):
    try:
        await asyncio.sleep(1000)
    finally:
        agent.print("cancelled at ", agent.now() % 60)
"""
    program = (
        "!a. !b. +!a <- my.long; .print(never). +!b <- .wait(2000); .drop_desire(a); .wait(10); .print(end)."
    )
    result = run(tmp_path, program, python)
    assert result.of("t") == ["cancelled at 2", "end"]
    assert result.errors == []
    assert result.seconds < 10


def test_the_end_of_a_run_cancels_coroutines(tmp_path):
    python = """
import asyncio
from pathlib import Path

@internal_action
async def long():
    try:
        await asyncio.sleep(1000)
    finally:
        await asyncio.sleep(0.1)
        Path(__file__).with_name("tidy").touch()
"""
    result = run(tmp_path, "!a. +!a <- my.long. !b. +!b <- .wait(50); .stopMAS.", python)
    assert result.errors == []
    assert (tmp_path / "tidy").exists()


@pytest.mark.parametrize("word", ["def", "async def"])
@pytest.mark.parametrize("what", ["sys.exit(3)", "raise asyncio.CancelledError", "raise RecursionError"])
def test_a_system_exit_does_not_end_the_run(tmp_path, word, what):
    python = f"import asyncio, sys\n\n@internal_action\n{word} quit():\n    {what}\n"
    result = run(tmp_path, "!go. +!go <- my.quit. -!go[error(E)] <- .print(E).", python)
    assert result.of("t") == ["internal_action"]
    assert len(result.errors) == 1
    assert f"({tmp_path}/my.py:" in result.errors[0]
    assert result.exit_code == 0


def test_annotations_that_are_not_resolved_count_by_their_names(tmp_path):
    my = """
    from __future__ import annotations
    from typing import TYPE_CHECKING
    from jacaros import internal_action

    if TYPE_CHECKING:
        from collections.abc import Iterator
        from jacaros import Agent, Out

    @internal_action
    def hello(agent: Agent, word: str, result: Out) -> None:
        result.set(f"{word} {agent.name}")

    @internal_action
    def each(n: int) -> Iterator[int]:
        yield from range(n)

    @internal_action
    def test(n: int) -> Iterator[None]:
        yield
    """
    program = '!go. +!go <- my.hello("hi", X); .print(X); my.each(3, Y); .print(Y); my.test(1); .print(ok).'
    assert said(write(tmp_path, my=my), program) == ["hi t", "0", "ok"]


def test_a_package_is_searched_file_by_file(tmp_path):
    write(
        tmp_path,
        my____init__="",
        my__sizes="SIZE = 3\n",
        my__norm=(
            "from jacaros import internal_action\nfrom .sizes import SIZE\n\n@internal_action\n"
            "def norm(x: float) -> float:\n    return SIZE * x\n"
        ),
        my__shapes=(
            "from jacaros import internal_action\n\n@internal_action\ndef area(x: float) -> "
            "float:\n    return x * x\n"
        ),
    )
    assert said(tmp_path, '!go. +!go <- my.norm(2, X); my.shapes.area(3, Y); .print(X, " ", Y).') == ["6 9"]


def test_artifacts_and_internal_actions_share_their_modules(tmp_path):
    write(
        tmp_path,
        artifacts="""
        from jacaros.artifacts import Artifact, operation
        from my import MEMORY

        class Store(Artifact):
            @operation
            def put(self, item: int) -> None:
                MEMORY.append(item)
        """,
    )
    python = "MEMORY = []\n\n@internal_action\ndef kept() -> list[int]:\n    return MEMORY\n"
    program = '!go. +!go <- makeArtifact(s, "Store", [], _); put(4); put(5); my.kept(L); .print(L).'
    assert said(tmp_path, program, python) == ["[4,5]"]


def test_a_module_that_cannot_be_imported_is_reported_with_its_line(tmp_path):
    result = run(tmp_path, "!go. +!go <- my.one(X); .print(", "import nowhere_at_all\n")
    assert result.exit_code == 1
    (told,) = result.errors
    assert f"{tmp_path}/my.py:3: ModuleNotFoundError: No module named 'nowhere_at_all'" in told
    assert "t.asl:1:" in told


@pytest.mark.parametrize(
    ("python", "message"),
    [
        ("@internal_action('your.one')\ndef one(): pass\n", "my.py:3: no program can find your.one"),
        ("@internal_action\ndef one(*, x): pass\n", "my.py:3: my.one: one: agents cannot pass the keyword"),
        ("@internal_action\nasync def one():\n    yield 1\n", "cannot be an internal action"),
        ("@internal_action('one')\ndef one(): pass\n", "must begin with the module, as in 'my.norm'"),
        (
            "@internal_action\ndef one(): pass\n@internal_action('my.one')\ndef two(): pass\n",
            "my.one is declared twice",
        ),
    ],
)
def test_an_invalid_declaration_is_reported_with_its_line(tmp_path, python, message):
    result = run(tmp_path, "!go. +!go <- my.one.", python)
    assert result.exit_code == 1
    assert message in result.errors[0]


@pytest.mark.parametrize(
    ("call", "help"),
    [
        ("my.nrom(1, X)", "did you mean `my.norm`?"),
        ("my.plain(1, X)", "put @internal_action before the function my.plain"),
        ("my.zzz(1, X)", "add a function `zzz` with @internal_action to my.py"),
        ("your.norm(1, X)", "write a function `norm` with @internal_action in your.py beside the project"),
    ],
)
def test_an_unknown_name_is_an_action_and_gets_help(tmp_path, call, help):
    python = "@internal_action\ndef norm(x) -> int:\n    return x\n\ndef plain(x):\n    return x\n"
    result = run(tmp_path, f"!go. +!go <- {call}. -!go[error(E)] <- .print(E).", python)
    assert result.of("t") == ["action_failed"]
    assert len(result.errors) == 1
    assert f"unknown internal action `{call.partition('(')[0]}`" in result.errors[0]
    assert f"  = help: {help}" in result.errors[0] or help in result.errors[0]


def test_an_agent_made_later_brings_its_modules(tmp_path):
    write(
        tmp_path,
        late_asl="!go. +!go <- more.say(X); .print(X).",
        more=HEAD + "@internal_action\ndef say() -> str:\n    return 'hello'\n",
    )
    result = run(tmp_path, '!go. +!go <- .create_agent(late, "late.asl").')
    assert result.lines == ["[late] hello"]
    assert result.errors == []


def test_the_modules_of_two_projects_do_not_mix(tmp_path):
    for number in ("1", "2"):
        folder = tmp_path / number
        folder.mkdir()
        python = f"@internal_action\ndef number() -> int:\n    return {number}\n"
        assert said(folder, "!go. +!go <- my.number(X); .print(X).", python) == [number]


def test_modules_beside_the_project_file_serve_programs_elsewhere(tmp_path):
    write(
        tmp_path,
        sys_mas2j='MAS sys { agents: bob; aslSourcePath: "src/asl"; }',
        my=HEAD + "@internal_action\ndef one() -> int:\n    return 1\n",
    )
    (tmp_path / "src" / "asl").mkdir(parents=True)
    (tmp_path / "src" / "asl" / "bob.asl").write_text("!go. +!go <- my.one(X); .print(X).")
    result = run_project(tmp_path / "sys.mas2j", until_idle=True)
    assert (result.lines, result.errors) == (["[bob] 1"], [])
