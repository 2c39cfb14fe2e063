"""Agents whose class is the project's: selection of options, messages, death."""

from pathlib import Path

import pytest
from extension_lab import assert_output, write
from recording_host import programs

from jacaros.runtime.mas.checks.files import check_files
from jacaros.testing import RunResult, run_project

HEAD = "from jacaros import *\n\n"


def run(
    folder: Path, program: str, python: str, agent: str = "agentClass my.Mine", **files: str
) -> RunResult:
    """Run an agent ``bob`` of a class of ``my.py``; others are declared by the files ``NAME_asl``."""
    others = "".join(f" {name.removesuffix('_asl')};" for name in files if name.endswith("_asl"))
    write(folder, sys_mas2j=f"MAS sys {{ agents: bob {agent};{others} }}", bob_asl=program, **files)
    write(folder, my=HEAD + python)
    return run_project(folder / "sys.mas2j", until_idle=True)


PROGRAMS = r"""
an option is selected by the class => high72 | middle8 | no_relevant
    class Mine(Agent):
        def select_option(self, options):
            return max(options, key=lambda option: option.plan.annotation("priority", 0))
    ---
    p(1). p(2).
    !go(7). !go(8). !none.
    @a +!go(X) : p(Y) <- .print(low).
    @b[priority(2)] +!go(X) : p(Y) & Y > 1 & X == 7 <- .print(high, X, Y).
    @c[priority(1)] +!go(Y) <- .print(middle, Y).
    -!none[error(E)] <- .print(E).
the bindings of options are seen and none may be taken => 4 | 9 | ! no applicable plan for !none
    class Mine(Agent):
        def select_option(self, options):
            return next((option for option in options if option.bindings.get("Y", 0) > 3), None)
    ---
    !go(X). !go(9). !none.
    +!go(Y) : Y = 2 <- .print(Y).
    +!go(Y) : Y = 4 | Y = 9 <- .print(Y).
    -!go(Y)[error(E)] <- .print(E).
    +!none : Y = 2 <- .print(no).
an option that is not offered is logged and the first is used
=> a | ! it returned 'this one', which is not one of the choices
    class Mine(Agent):
        def select_option(self, options):
            return "this one"
    ---
    !a. +!a : true <- .print(a). +!a <- .print(b).
every answer of a plan for all unifiers is an option => 8
    class Mine(Agent):
        def select_option(self, options):
            return max(options, key=lambda option: option.bindings.get("Y", 0))
    ---
    p(3). p(8). p(5).
    !go(W).
    @a[all_unifs] +!go(X) : p(Y) <- X = Y; .print(Y).
    @b +!go(X) : p(Y) <- .print(no).
the contexts of options are asked once => asked | 78
    class Mine(Agent):
        def select_option(self, options):
            return options[0]

    @internal_action
    def once(agent: Agent) -> int:
        agent.print("asked")
        if agent.believes("used"):
            return None
        agent.add_belief("used")
        return 7
    ---
    !go. +!go : my.once(X) & Y = X + 1 <- .print(X, Y). +!go <- .print(second).
texts parsed at run time can name Python code => 15 | 26
    @internal_action
    def double(x: float) -> float:
        return 2 * x

    @arithmetic_function
    def sq(x: float) -> float:
        return x * x
    ---
    !go.
    +!go <- .add_plan("+!late(X) : my.double(X, Y) <- .print(Y + my.sq(X))."); !late(3);
            .term2string(T, "my.sq(5)"); .print(T + 1).
"""


@programs(PROGRAMS)
def test_what_a_program_prints(tmp_path, program, output):
    assert_output(tmp_path, program, output)


def test_messages_are_refused_by_the_class(tmp_path):
    python = """
class Mine(Agent):
    def soc_acc(self, message):
        return message.content.arguments[0] < 5
"""
    ann = "!go. +!go <- for (.range(I, 1, 6)) { .send(bob, tell, n(I)) }."
    result = run(tmp_path, "+n(X)[source(S)] <- .print(S, X).", python, ann_asl=ann)
    assert (result.of("bob"), result.errors) == (["ann1", "ann2", "ann3", "ann4"], [])


def test_an_agent_need_not_accept_its_end(tmp_path):
    python = """
class Mine(Agent):
    def kill_acc(self, killer):
        return killer == "boss"
"""
    boss = "!go. +!go <- .wait(100); .kill_agent(bob); .print(killed). -!go <- .print(refused)."
    ann = "!go. +!go <- .kill_agent(bob); .print(killed). -!go <- .print(refused)."
    result = run(tmp_path, "", python, boss_asl=boss, ann_asl=ann)
    assert result.lines == ["[ann] refused", "[boss] killed"]


def test_an_error_in_the_class_is_logged_and_the_default_is_used(tmp_path):
    python = """
class Mine(Agent):
    def select_option(self, options):
        return 1 / 0

    def soc_acc(self, message):
        raise ValueError("who is it?")
"""
    ann = "!go. +!go <- .send(bob, achieve, a)."
    result = run(tmp_path, "+!a : true <- .print(a). +!a <- .print(b).", python, ann_asl=ann)
    assert result.of("bob") == ["a"]
    assert f"Mine.soc_acc: ValueError: who is it? ({tmp_path}/my.py:9)" in result.errors[0]
    assert f"Mine.select_option: ZeroDivisionError: division by zero ({tmp_path}/my.py:6)" in result.errors[1]


@pytest.mark.parametrize(
    ("declared", "message"),
    [
        ("agentClass my.Mien", "unknown class Mien in"),
        ("agentClass my.Mien", "did you mean `my.Mine`?"),
        ("agentClass my.Mine(1 2)", "invalid arguments of my.Mine(1 2)"),
        ("agentClass broken.Mine", "broken.py:1: NameError"),
        ("agentClass my.Mine(1)", "takes 1 positional argument but 2 were given"),
        ("agentClass my.Broken", "my.py:9)"),
    ],
)
def test_an_unknown_class_is_reported_before_anything_runs(tmp_path, declared, message):
    python = "class Mine(Agent):\n    def init(self):\n        pass\n\n"
    python += "class Broken(Agent):\n    def init(self):\n        1 / 0\n"
    result = run(tmp_path, "!go. +!go <- .print(hello).", python, declared, broken="undefined_name\n")
    assert (result.exit_code, result.lines) == (1, [])
    assert message in "\n".join(result.errors)
    assert "sys.mas2j:1:" in "\n".join(result.errors)


def test_a_java_class_is_reported_and_has_no_effect(tmp_path):
    result = run(tmp_path, "!go. +!go <- .print(hello).", "", "agentClass your.Careful")
    assert result.of("bob") == ["hello"]
    assert "the Java class `your.Careful` has no effect" in result.errors[0]
    assert "`class Careful(jacaros.Agent)` in your.py" in result.errors[0]


def test_an_agent_made_at_run_time_can_be_of_a_class(tmp_path):
    python = """
class Mine(Agent):
    def init(self, word):
        self.add_belief(Literal("word", (word,)))
"""
    program = """
    !go.
    +!go <- .create_agent(sue, "sue_of_bob.asl",
                [agentClass("my.Mine(hi)"), beliefBaseClass("my.Loud"), agentArchClass("jaca.CAgentArch")]);
            .create_agent(joe, "sue_of_bob.asl", [agentClass("my.Missing")]).
    -!go[error(E)] <- .print(E).
    """
    write(tmp_path)
    (tmp_path / "sue_of_bob.asl").write_text("!go. +!go : word(W) <- .print(W).")
    result = run(tmp_path, program, python, "")
    assert result.lines == ["[bob] internal_action", "[sue] hi"]
    assert "the belief base `my.Loud` of agent sue has no effect" in result.errors[0]
    assert "unknown class Missing" in result.errors[1]


def test_python_code_can_look_at_beliefs_and_talk(tmp_path):
    python = """
@internal_action
def look(agent: Agent) -> list[str]:
    agent.send("ann", "tell", "hello(3)[x]")
    agent.log("looking")
    assert agent.believes("p(X) & X > 1") and not agent.believes("p(9)")
    assert repr(agent) == "Agent('bob')"
    assert [b.arguments for b in agent.beliefs("p", 1)] == [(1,), (2,)]
    return sorted(str(answer["X"]) for answer in agent.ask("p(X)"))
"""
    ann = "+hello(X)[source(S)] <- .print(X, S)."
    result = run(tmp_path, "p(1). p(2). !go. +!go <- my.look(L); .print(L).", python, "", ann_asl=ann)
    assert sorted(result.lines) == ["[ann] 3bob", '[bob] ["1","2"]']
    assert result.errors == ["[bob] info: looking"]


def test_a_plan_after_a_general_one_is_reachable_if_the_class_selects(tmp_path):
    python = """
class Mine(Agent):
    def select_option(self, options):
        return options[-1]
"""
    result = run(tmp_path, "!go(1). +!go(_) <- .print(any). +!go(1) <- .print(one).", python)
    assert (result.of("bob"), result.errors) == (["one"], [])
    assert check_files([tmp_path / "sys.mas2j"]).diagnostics == []


def test_a_clone_is_of_the_same_class(tmp_path):
    python = """
class Mine(Agent):
    def select_option(self, options):
        return options[-1]
"""
    program = (
        "!go. +!go <- .clone(twin); .send(twin, achieve, try). +!try <- .print(first). +!try <- .print(last)."
    )
    assert run(tmp_path, program, python).of("twin") == ["last"]


def test_a_check_looks_at_the_classes_and_the_python_code(tmp_path):
    write(
        tmp_path,
        sys_mas2j="MAS sys { agents: bob agentClass my.Mien; sue agentClass your.Mine; }",
        bob_asl="!go. +!go <- my.one(X, Y); .print(X, Y).",
        sue_asl="!go. +!go <- X = my.sq(2) + 1; .print(X); my.oen(Y); .print(Y).",
        my=HEAD + "class Mine(Agent):\n    pass\n\n@internal_action\ndef one(x: Out):\n    pass\n\n"
        "@arithmetic_function\ndef sq(x):\n    return x * x\n",
    )
    found = check_files([tmp_path / "sys.mas2j"]).diagnostics
    assert sorted((each.severity, each.message.partition(" in /")[0]) for each in found) == [
        ("error", "unknown class Mien"),
        ("warning", "internal action `my.one` expects 1 argument, found 2"),
        ("warning", "the Java class `your.Mine` has no effect"),
        ("warning", "unknown internal action `my.oen`"),
    ]
