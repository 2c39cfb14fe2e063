"""Occupancy grids: what scans, and agents, say of cells."""

import pytest

from jacaros.robots.map.cells import FREE, OBSTACLE, OccupancyCells


def grid(size: float = 1.0) -> OccupancyCells:
    return OccupancyCells(OBSTACLE, size)


def test_a_beam_clears_the_cells_that_it_passes_and_marks_its_echo() -> None:
    cells = grid()
    cells.add_scan((0.0, 0.0), [(3.0, 0.0)], [(2.6, 0.0)])
    assert [cells.label((x, 0)) for x in range(5)] == [FREE, FREE, FREE, OBSTACLE, None]
    assert cells.known() == {(0, 0), (1, 0), (2, 0), (3, 0)}


@pytest.mark.parametrize(
    ("end", "passed"),
    [
        ((2.0, 1.0), {(0, 0), (1, 0), (1, 1)}),
        ((-2.0, -1.0), {(0, 0), (-1, 0), (-1, -1)}),
        ((0.0, -2.0), {(0, 0), (0, -1)}),
        ((0.3, 0.2), set()),
    ],
)
def test_a_beam_passes_the_cells_on_its_line(end: tuple[float, float], passed: set[tuple[int, int]]) -> None:
    cells = grid()
    cells.add_scan((0.0, 0.1), [], [end])
    assert passed <= cells.known()
    assert cells.cell_at(*end) not in cells.known()
    assert len(cells.known()) <= len(passed) + 1


def test_a_cell_with_an_echo_is_not_cleared_by_another_beam_of_the_scan() -> None:
    cells = grid()
    cells.add_scan((0.0, 0.0), [(2.0, 0.0)], [(4.0, 0.0)])
    assert cells.label((2, 0)) == OBSTACLE
    assert cells.label((3, 0)) == FREE


def test_the_majority_of_scans_counts_and_changes_are_noticed() -> None:
    cells = grid()
    for _ in range(20):
        cells.add_scan((0.0, 0.0), [(2.0, 0.0)], [])
    cells.add_scan((0.0, 0.0), [], [(4.0, 0.0)])
    assert cells.label((2, 0)) == OBSTACLE
    for _ in range(10):
        cells.add_scan((0.0, 0.0), [], [(4.0, 0.0)])
    assert cells.label((2, 0)) == FREE


def test_labels_of_agents_go_before_what_is_seen_but_open_no_way() -> None:
    cells = grid()
    cells.add_scan((0.0, 0.0), [(3.0, 0.0)], [(3.0, 0.0)])
    cells.put((1, 0), "home")
    cells.put((5, 0), "goal")
    cells.put((2, 0), OBSTACLE)
    cells.put((6, 0), FREE)
    assert cells.label((1, 0)) == "home"
    assert cells.seen((1, 0)) == FREE
    assert cells.passable() == {(0, 0), (1, 0), (6, 0)}
    assert cells.blocked() == {(2, 0), (3, 0)}
    assert cells.near((4, 0), 1) == [(3, 0), (5, 0)]
    cells.clear()
    assert not cells.known()


def test_cells_have_their_centres_at_multiples_of_their_size() -> None:
    cells = grid(0.1)
    assert cells.cell_at(0.04, -0.04) == (0, 0)
    assert cells.cell_at(0.06, -0.06) == (1, -1)
