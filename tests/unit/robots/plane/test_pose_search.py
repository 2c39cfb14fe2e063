"""The search of a map for poses, compared with one that looks at each pose and each echo."""

import math

from hypothesis import given
from hypothesis import strategies as st

from jacaros.robots.plane.pose import Point, Pose
from jacaros.robots.plane.pose_search import HEADINGS, MOST, Cell, PoseSearch, disc

CELLS = st.tuples(st.integers(-6, 6), st.integers(-6, 6))
ECHOES = st.tuples(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0))


def counted(walls: set[Cell], pose: Pose, echoes: list[Point], size: float, near: float) -> int:
    """The number of echoes on walls, as `PoseSearch` rounds."""
    sine, cosine = math.sin(pose.yaw) / size, math.cos(pose.yaw) / size
    column, row = round(pose.x / size), round(pose.y / size)
    cells = [(column + round(cosine * x - sine * y), row + round(sine * x + cosine * y)) for x, y in echoes]
    return sum(any((a + dx, b + dy) in walls for dx, dy in disc(near / size)) for a, b in cells)


@given(
    walls=st.sets(CELLS, min_size=1, max_size=30),
    floor=st.sets(CELLS, min_size=1, max_size=20),
    echoes=st.lists(ECHOES, min_size=1, max_size=9),
    least=st.sampled_from([0.3, 0.75, 1.0]),
)
def test_all_poses_with_enough_echoes_on_walls_are_found_with_their_number(
    walls: set[Cell], floor: set[Cell], echoes: list[Point], least: float
) -> None:
    size, near = 0.5, 0.5
    search = PoseSearch(walls, floor, size, near, 3.0)
    needed = math.ceil(least * len(echoes))
    for number, fits in enumerate(search.poses(echoes, least)):
        yaw = math.remainder(number * math.tau / HEADINGS, math.tau)
        poses = [Pose(x * size, y * size, yaw) for x, y in floor]
        expected = {(counted(walls, pose, echoes, size, near), pose) for pose in poses}
        assert set(fits) == {each for each in expected if each[0] >= needed}


def test_a_corridor_gives_only_the_poses_that_match_best() -> None:
    walls = [(x, y) for x in range(1000) for y in (0, 20)]
    floor = [(x, y) for x in range(1000) for y in range(1, 20)]
    echoes = [(0.01 * number, side) for number in range(12) for side in (1.0, -1.0)]
    search = PoseSearch(walls, floor, 0.1, 0.1, 4.0)
    ahead = next(search.poses(echoes, 0.5))
    assert len(ahead) > MOST
    assert {fit.echoes for fit in ahead} == {24}
    assert {round(fit.pose.y, 1) for fit in ahead} <= {0.9, 1.0, 1.1}
