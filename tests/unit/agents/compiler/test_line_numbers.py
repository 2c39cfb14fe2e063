"""Generated text is compiled with the line numbers of the agent program."""

import traceback

import pytest

from jacaros.agents.mind.generated import function

TEXT = """def first(x):
    if x:
        for y in range(3):
            try:
                x = [z * 2 for z in [y]]
            except ValueError: raise
        return inner(lambda: 1 / (x[0] - 4))
    return None
def inner(call):
    return call()
"""
ORIGINS = [0, 900, 900, 7, 7, 100_000, 7, 12, 900, 3, 3, 3]


def test_a_traceback_shows_the_lines_of_the_program():
    names = {}
    exec(function.compile_text(TEXT, ORIGINS, "program.asl"), names)
    with pytest.raises(ZeroDivisionError) as raised:
        names["first"](True)
    places = [(f.filename, f.lineno, f.name) for f in traceback.extract_tb(raised.value.__traceback__)[1:]]
    assert places == [
        ("program.asl", 12, "first"),
        ("program.asl", 3, "inner"),
        ("program.asl", 12, "<lambda>"),
    ]
    assert names["first"].__code__.co_firstlineno == 900
