"""Arithmetic functions that a project writes in Python."""

from extension_lab import assert_output, said
from recording_host import programs

from jacaros.agents.terms import operators
from jacaros.testing import AgentHarness

SQ = """
@arithmetic_function("my.sq")
def sq(x):
    return x * x

@arithmetic_function
def largest(*numbers: float) -> float:
    return max(numbers)

@arithmetic_function
def area(shape) -> float:
    return shape.arguments[0] * shape.arguments[1]

@arithmetic_function
def broken(x):
    raise ValueError("not today")

@arithmetic_function
def word(x):
    return "four"
"""


PROGRAMS = """
a function stands in expressions and conditions => 10 | 4 | 7 | yes | 8 | ok
    large(X) :- my.sq(X) > 10.
    side(4).
    !go.
    +!go : side(S) & large(S)
      <- X = my.sq(3) + 1; .print(X); .print(my.sq(my.sq(2)) / 4); .print(my.largest(1, 7, 3));
         if (my.sq(S) == 16) { .print(yes) }; .print(my.area(box(2, S))); +side(my.sq(S)); ?side(16); .print(ok).
a function waits for its arguments => 10
    !go. +!go <- Y = my.sq(X) + 1; X = 3; .print(Y).
a function may be registered => 9
    { register_function("my.sq") } !go. +!go <- .print(my.sq(3)).
a Java function is reported => hello | ! a function sq with @arithmetic_function in your.py
    { register_function("your.sq") } !go. +!go <- .print(hello).
a wrong number of arguments is reported => ! my.sq
    !go. +!go <- X = my.sq(1, 2).
a function that returns no number fails the step
=> arithmetic_error | ! my.word: the function returned 'four', which is not a number
    !go. +!go <- X = my.word(1). -!go[error(E)] <- .print(E).
an exception fails the step
=> arithmetic_error | ! [t] error: my.broken: ValueError: not today (FOLDER/my.py:18)
    !go. +!go <- X = my.broken(1); .print(X).
    -!go[error(E), error_msg("my.broken: ValueError: not today (FOLDER/my.py:18)")] <- .print(E).
"""


@programs(PROGRAMS)
def test_what_a_program_prints(tmp_path, program, output):
    assert_output(tmp_path, f"{SQ}---\n{program}", output)


def test_the_functions_of_a_project_are_gone_after_its_run(tmp_path):
    said(tmp_path, "!go. +!go <- .print(my.sq(3)).", SQ)
    assert "my.sq" not in operators.function_table


def test_two_projects_have_functions_of_one_name_at_the_same_time(tmp_path):
    module = (
        "from jacaros import arithmetic_function\n@arithmetic_function\ndef size(x):\n    return {result}\n"
    )
    agents = []
    for name, result in (("one", 1), ("two", 2)):
        folder = tmp_path / name
        folder.mkdir()
        (folder / "my.py").write_text(module.format(result=result), encoding="utf-8")
        file = folder / "agent.asl"
        file.write_text(
            'first(my.size(0)). +!g <- ?first(F); .term2string(T, "my.size(0) + 10"); .print(F, my.size(0), T + 0).',
            encoding="utf-8",
        )
        agents.append(AgentHarness(file))
    for agent in agents:
        agent.achieve("g")
        agent.run()
    assert [agent.prints for agent in agents] == [["1111"], ["2212"]]
    assert "my.size" not in operators.function_table
