"""The buffer of transforms, compared with plain matrices."""

import math

import numpy
import pytest
from hypothesis import given
from hypothesis import strategies as st

from jacaros.robots.ros.errors import TransformUnavailable
from jacaros.robots.ros.protocols.transform import Quaternion, Transform, TransformBuffer, interpolate


def buffer(lines: list[str] | None = None, *inserted: tuple[str, str, Transform]) -> TransformBuffer:
    known = TransformBuffer(([] if lines is None else lines).append)
    for parent, child, transform in inserted:
        known.insert(parent, child, transform)
    return known


def moving(*stamps: float) -> TransformBuffer:
    """A buffer in which the base is at x metres at x seconds."""
    return buffer(None, *(("odom", "base", at(stamp, stamp=stamp)) for stamp in stamps))


def turned(yaw: float) -> Quaternion:
    return (0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))


def at(x: float, y: float = 0.0, yaw: float = 0.0, stamp: float = 0.0) -> Transform:
    return Transform((x, y, 0.0), turned(yaw), stamp)


def matrix(transform: Transform) -> numpy.ndarray:
    """The same transform as a homogeneous matrix, written down from the definition of a quaternion's rotation."""
    x, y, z, w = transform.rotation
    made = numpy.eye(4)
    made[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    made[:3, 3] = transform.translation
    return made


unit = st.tuples(*[st.floats(-1, 1) for _ in range(4)]).filter(lambda q: math.hypot(*q) > 0.1)
rotations = unit.map(lambda q: tuple(part / math.hypot(*q) for part in q))
transforms = st.builds(Transform, st.tuples(*[st.floats(-50, 50) for _ in range(3)]), rotations)


@given(st.lists(transforms, min_size=1, max_size=5), st.lists(transforms, max_size=5))
def test_a_look_up_is_the_product_of_the_matrices_on_the_way(
    left: list[Transform], right: list[Transform]
) -> None:
    known = buffer()
    ways = {"left": numpy.eye(4), "right": numpy.eye(4)}
    ends = {}
    for side, chain in (("left", left), ("right", right)):
        parent = "root"
        for number, transform in enumerate(chain):
            known.insert(parent, f"{side}{number}", transform, static=True)
            ways[side] = ways[side] @ matrix(transform)
            parent = f"{side}{number}"
        ends[side] = parent
    found = known.lookup(ends["right"], ends["left"])
    numpy.testing.assert_allclose(
        matrix(found), numpy.linalg.inv(ways["right"]) @ ways["left"], rtol=1e-6, atol=1e-6
    )


@given(transforms, transforms, st.floats(0, 1))
def test_between_two_transforms_the_rotation_is_even(a: Transform, b: Transform, ratio: float) -> None:
    between = interpolate(a, b, ratio)

    def angle(p: Quaternion, q: Quaternion) -> float:
        return 2 * math.acos(min(1.0, abs(sum(i * j for i, j in zip(p, q, strict=True)))))

    whole = angle(a.rotation, b.rotation)
    assert angle(a.rotation, between.rotation) == pytest.approx(ratio * whole, abs=1e-3)
    assert angle(between.rotation, b.rotation) == pytest.approx((1 - ratio) * whole, abs=1e-3)
    assert math.hypot(*between.rotation) == pytest.approx(1.0)
    for place in range(3):
        expected = a.translation[place] * (1 - ratio) + b.translation[place] * ratio
        assert between.translation[place] == pytest.approx(expected, abs=1e-9)


def test_between_two_times_it_is_interpolated() -> None:
    known = buffer(
        None,
        ("odom", "base", at(0.0, yaw=math.radians(170), stamp=10.0)),
        ("odom", "base", at(1.0, yaw=math.radians(-170), stamp=11.0)),
    )
    found = known.lookup("odom", "base", 10.25)
    assert found.translation[0] == pytest.approx(0.25)
    assert math.degrees(found.yaw) == pytest.approx(175.0)
    assert found.stamp == 10.25


def test_without_a_time_the_newest_common_one_counts() -> None:
    known = moving(1.0, 2.0, 3.0)
    known.insert("map", "odom", at(10.0, stamp=1.0))
    known.insert("base", "laser", at(0.5), static=True)
    found = known.lookup("map", "laser")
    assert found.stamp == 1.0
    assert found.translation[0] == pytest.approx(11.5)
    assert known.lookup("odom", "laser").stamp == 3.0
    assert known.lookup("base", "laser").stamp == 0.0


def test_messages_in_any_order_give_the_same() -> None:
    known = moving(3.0, 1.0, 2.0, 2.0)
    assert known.lookup("odom", "base", 2.0).translation[0] == 2.0
    assert known.lookup("odom", "base", 1.5).translation[0] == 1.5


@pytest.mark.parametrize(
    ("stamp", "reason", "word"), [(0.5, "too_old", "later"), (3.5, "too_new", "earlier")]
)
def test_outside_of_what_is_known_nothing_is_made_up(stamp: float, reason: str, word: str) -> None:
    text = f"no transform from base to odom at {stamp:.6f}: base is known from 1.000000 to 3.000000 only, 0.500000 s {word}"
    with pytest.raises(TransformUnavailable) as caught:
        moving(1.0, 3.0).lookup("odom", "base", stamp)
    assert (caught.value.reason, str(caught.value)) == (reason, text)


def test_history_is_ten_seconds_long() -> None:
    known = moving(*map(float, range(100)))
    assert known.lookup("odom", "base", 89.5).translation[0] == 89.5
    with pytest.raises(TransformUnavailable, match=r"known from 89\.0"):
        known.lookup("odom", "base", 88.9)


A, B, WORLD = ("odom", "base_link", at(1.0)), ("a", "b", at(1.0)), ("world", "camera", at(1.0))


@pytest.mark.parametrize(
    ("known", "target", "source", "reason", "text"),
    [
        ([], "map", "base_link", "unknown_frame", "no transforms have arrived"),
        ([A], "odom", "base_lnk", "unknown_frame", "unknown frame base_lnk; did you mean `base_link`?"),
        ([A], "odom", "base_lnk", "unknown_frame", "Known: base_link, odom"),
        (
            [A, WORLD],
            "camera",
            "base_link",
            "not_connected",
            "root of base_link is odom, the root of camera is world",
        ),
        ([B, ("b", "a", at(1.0))], "a", "b", "not_connected", "form a cycle"),
    ],
)
def test_frames_without_a_way_are_reported(
    known: list[tuple[str, str, Transform]], target: str, source: str, reason: str, text: str
) -> None:
    with pytest.raises(TransformUnavailable) as caught:
        buffer(None, *known).lookup(target, source)
    assert caught.value.reason == reason
    assert text in str(caught.value)


def test_a_frame_may_change_its_parent() -> None:
    known = buffer(None, ("table", "cup", at(0.5, stamp=1.0)), ("gripper", "cup", at(0.1, stamp=2.0)))
    known.insert("world", "table", at(5.0), static=True)
    known.insert("world", "gripper", at(1.0), static=True)
    assert known.lookup("world", "cup").translation[0] == pytest.approx(1.1)
    assert known.lookup("world", "cup", 1.5).translation[0] == pytest.approx(5.5)


def test_a_slash_in_front_is_dropped() -> None:
    known = buffer(None, ("/odom", "/base", at(2.0)))
    assert known.lookup("odom", "/base").translation[0] == 2.0
    assert known.frames == ["base", "odom"]


@pytest.mark.parametrize(
    ("parent", "child", "transform", "fault"),
    [
        ("odom", "", at(1.0), "a frame has an empty name"),
        ("odom", "odom", at(1.0), "frame odom is its own parent"),
        ("odom", "base", at(math.nan), "contains NaN or infinity"),
        ("odom", "base", at(1.0, stamp=math.inf), "contains NaN or infinity"),
        ("odom", "base", Transform(rotation=(0.0, 0.0, 0.0, 0.0)), "is not a unit quaternion"),
    ],
)
def test_nonsense_is_not_taken(parent: str, child: str, transform: Transform, fault: str) -> None:
    known = buffer()
    assert fault in (known.insert(parent, child, transform) or "")
    assert known.frames == []


def test_one_old_message_is_dropped() -> None:
    lines: list[str] = []
    stamps = (100.0, 1.0, 101.0, 2.0, 102.0)
    known = buffer(lines, *(("odom", "base", at(stamp, stamp=stamp)) for stamp in stamps))
    assert known.lookup("odom", "base", 101.5).translation[0] == 101.5
    assert lines == []


def test_a_restart_of_time_clears_the_past() -> None:
    lines: list[str] = []
    known = buffer(lines)
    known.insert("base", "laser", at(0.5), static=True)
    known.insert("map", "odom", at(7.0, stamp=100.0))
    known.insert("odom", "base", at(100.0, stamp=100.0))
    for stamp in (1.0, 1.1, 1.2):
        known.insert("odom", "base", at(stamp, stamp=stamp))
    assert known.lookup("odom", "laser").translation[0] == pytest.approx(1.7)
    assert lines == [
        "the stamps of frame base went back by 98.8 s; the transforms known so far are forgotten"
    ]
    with pytest.raises(TransformUnavailable, match="unknown frame map"):
        known.lookup("map", "base")


def test_between_two_parents_the_old_one_is_valid() -> None:
    known = buffer(None, ("left", "box", at(1.0, stamp=1.0)), ("right", "box", at(5.0, stamp=2.0)))
    assert known.lookup("left", "box", 1.5).translation == (1.0, 0.0, 0.0)
    with pytest.raises(TransformUnavailable, match="not connected"):
        known.lookup("right", "box", 1.5)
