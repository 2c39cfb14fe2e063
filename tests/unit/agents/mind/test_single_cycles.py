"""It makes no difference to an agent how many cycles it is given at a time."""

import pytest
from recording_host import mind

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
