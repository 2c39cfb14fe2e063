"""Sizes of solutions of the workshop's problems: ours are counted, those of others have their source."""

import re

from workshop import published


def test_ours_are_counted_once_for_each_setting_and_once_for_all() -> None:
    ours = {row.part: row for row in published.our_rows()}
    assert list(ours) == [*published.SETTINGS, published.SHARED]
    for setting in published.SETTINGS:
        assert ours[setting].files == (f"{setting}/robot.asl",)
        text = (published.FOLDER / setting / "robot.asl").read_text(encoding="utf-8")
        assert ours[setting].lines == len(text.splitlines())
        # One comment line; blank lines are between the parts.
        assert ours[setting].code_lines == sum(bool(line) for line in text.splitlines()) - 1
    assert set(ours["shared"].files) == {"building.asl", "carrier.asl", "door.yaml", "gripper.yaml"}


def test_those_of_others_have_a_source_at_a_commit_and_fewer_code_lines_than_lines() -> None:
    rows = published.published_rows()
    assert {row.system for row in rows} == {"Python", "BehaviorTree.CPP", "ros_bt_py", "FlexBE", "SkiROS2"}
    for row in rows:
        assert re.fullmatch(r"[\w-]+/[\w-]+, commit [0-9a-f]{40}, \S+", row.source)
        assert row.files
        assert 0 < row.code_lines <= row.lines
        for name in row.files:
            _, _, part = name.partition("#")
            if part and len(row.files) == 1:
                first, last = map(int, part.split("-"))
                assert row.lines == last - first + 1


def test_the_table_has_all_systems_and_their_totals() -> None:
    table = published.size_table()
    assert [row[0] for row in table.rows][:2] == ["JaCaROS", "Python"]
    tree = next(row for row in table.rows if row[0] == "BehaviorTree.CPP")
    assert tree[1:7] == ("18 / 16", "28 / 25", "48 / 44", "178 / 161", "609 / 447", "881 / 693")
    flexbe = next(row for row in table.rows if row[0] == "FlexBE")
    assert flexbe[1:5] == ("-", "506 / 266", "-", "-")
