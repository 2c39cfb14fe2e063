"""The square of one metre over a real graph."""

from collections.abc import Callable

from judging import distance, heading_error, nearest_pass
from processes import Agents, WorldProcess

CORNERS = ((1.0, 0.0), (1.0, 1.0), (0.0, 1.0))


def test_the_square_is_driven_and_closes(world: WorldProcess, run_agents: Callable[..., Agents]) -> None:
    agents = run_agents("square.asl")
    assert agents.end() == 0
    assert agents.lines == [f"[square] corner {number}" for number in (1, 2, 3, 4)]
    truth = world.close()
    for corner in CORNERS:
        assert nearest_pass(truth, corner) <= 0.05, corner
    back = truth.latest()
    assert distance(back, (0.0, 0.0)) <= 0.05
    assert heading_error(back, 0.0) <= 3.0
    assert 3.9 <= truth.odometer() <= 4.1
