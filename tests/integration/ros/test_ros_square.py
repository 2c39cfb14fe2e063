"""The example of the square over a real graph, judged by the example's own checker."""

from collections.abc import Callable

from examples_lab import EXAMPLES, checker
from processes import Agents, WorldProcess


def test_the_square_is_driven_and_closes(
    run_world: Callable[..., WorldProcess], run_agents: Callable[..., Agents]
) -> None:
    world = run_world("empty")
    agents = run_agents(EXAMPLES / "02_square/square.jcm")
    assert agents.end() == 0
    verdict = checker("02_square").check(world.close())
    print(*verdict.lines(), sep="\n")
    assert verdict.complaints == []
    assert [line.split(" done")[0] for line in agents.lines] == [f"[robot] side {n}" for n in (1, 2, 3, 4)]
    assert agents.complaints == []
    assert world.errors == []
