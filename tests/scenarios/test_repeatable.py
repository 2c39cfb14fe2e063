"""Two runs of an example with the same seed are the same run."""

import pytest
from examples_lab import PROJECTS, run, run_of


@pytest.mark.slow
@pytest.mark.parametrize("project", PROJECTS)
def test_two_runs_print_and_move_the_same(project: str) -> None:
    first, second = run_of(project), run(project)
    assert second.lines == first.lines
    assert second.seconds == first.seconds
    if first.ground_truth is not None:
        assert second.ground_truth.digest() == first.ground_truth.digest()
