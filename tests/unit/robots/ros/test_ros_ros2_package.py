"""The package of look-alikes that is generated for ROS 2."""

import re
import runpy
from pathlib import Path
from xml.etree import ElementTree

import pytest

from jacaros.robots.ros.interfaces import BUILT_IN, origin
from jacaros.robots.ros.interfaces import SUBSTITUTES as PACKAGE

TOOL = runpy.run_path(str(Path(__file__).parents[4] / "tools" / "ros2_package.py"))
definitions, similar_types, write_package = (
    TOOL[name] for name in ("definitions", "similar_types", "write_package")
)


def put(root: Path, name: str, text: str) -> None:
    path = root / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def test_all_definitions_are_in_it_and_in_its_list_of_files(tmp_path: Path) -> None:
    package = write_package(tmp_path)
    assert package == tmp_path / PACKAGE
    files = {path.relative_to(package).as_posix() for path in package.glob("*/*.*")}
    assert files == set(similar_types())
    assert {"action/Count.action", "action/NavigateToPose.action", "srv/AddTwoInts.srv"} <= files
    listed = set(re.findall(r'"(.*)"', (package / "CMakeLists.txt").read_text()))
    assert listed == files


def test_types_of_ros_1_alone_are_not_in_it() -> None:
    assert {"AutoDocking", "BumperEvent", "MoveBase"}.isdisjoint(
        found.name for found in similar_types().values()
    )
    assert similar_types()["msg/SensorState.msg"].package == "turtlebot3_msgs"
    assert origin("action", "MoveBase") is None


def test_rosidl_takes_the_names_of_all_types() -> None:
    """One that it refuses lets the whole package fail to build."""
    wrong = [
        found.name for found in similar_types().values() if not re.fullmatch(r"[A-Z][A-Za-z0-9]*", found.name)
    ]
    assert wrong == []


def test_the_manifest_names_what_the_definitions_need(tmp_path: Path) -> None:
    manifest = ElementTree.parse(write_package(tmp_path) / "package.xml").getroot()
    depends = {element.text for element in manifest.findall("depend")}
    assert {"action_msgs", "geometry_msgs", "std_msgs"} <= depends
    assert depends.isdisjoint({PACKAGE, *(found.package for found in similar_types().values())})
    assert manifest.findtext("member_of_group") == "rosidl_interface_packages"


def test_references_between_substitutes_stay_inside(tmp_path: Path) -> None:
    put(tmp_path / "in", "a_msgs/msg/Part.msg", "uint8 kind\n")
    put(
        tmp_path / "in",
        "b_msgs/msg/Whole.msg",
        "a_msgs/Part[] parts\na_msgs/msg/Part one\nstd_msgs/Header header\n",
    )
    package = write_package(tmp_path / "out", root=tmp_path / "in")
    assert (package / "msg/Whole.msg").read_text() == "Part[] parts\nPart one\nstd_msgs/Header header\n"
    assert "DEPENDENCIES std_msgs\n" in (package / "CMakeLists.txt").read_text()


def test_constants_of_an_earlier_part_are_omitted(tmp_path: Path) -> None:
    put(
        tmp_path / "in",
        "a_msgs/action/Do.action",
        "bool x\n---\nuint8 NONE=0\nuint8 code\n---\nuint8 NONE=0\nuint8 SOME=1\n",
    )
    package = write_package(tmp_path / "out", root=tmp_path / "in")
    text = (package / "action/Do.action").read_text()
    assert text == "bool x\n---\nuint8 NONE=0\nuint8 code\n---\nuint8 SOME=1\n"


def test_two_types_of_one_name_are_refused_unless_they_are_the_same(tmp_path: Path) -> None:
    put(tmp_path, "a_msgs/msg/Same.msg", "# one\nuint8 kind\n")
    put(tmp_path, "b_msgs/msg/Same.msg", "# other\nuint8 kind  # of it\n")
    assert list(similar_types(tmp_path)) == ["msg/Same.msg"]
    put(tmp_path, "b_msgs/msg/Same.msg", "uint16 kind\n")
    with pytest.raises(ValueError, match="the same name in jacaros_interfaces"):
        similar_types(tmp_path)


def test_packages_that_every_ros_2_has_are_left_to_it(tmp_path: Path) -> None:
    put(tmp_path, "nav_msgs/srv/GetMap.srv", "---\nOccupancyGrid map\n")
    put(tmp_path, "a_msgs/msg/Part.msg", "uint8 kind\n")
    assert list(similar_types(tmp_path)) == ["msg/Part.msg"]


def test_transforms_have_a_package_of_their_own_name(tmp_path: Path) -> None:
    package = write_package(tmp_path, "tf2_msgs")
    assert [path.name for path in package.glob("msg/*")] == ["TFMessage.msg"]
    assert "tf2_msgs" not in {found.package for found in similar_types().values()}
    with pytest.raises(ValueError, match="no definitions of no_msgs"):
        write_package(tmp_path, "no_msgs")


def test_what_is_written_replaces_what_was_there(tmp_path: Path) -> None:
    put(tmp_path, f"{PACKAGE}/msg/Old.msg", "uint8 gone\n")
    assert not (write_package(tmp_path) / "msg/Old.msg").exists()


def test_substitutes_know_their_originals() -> None:
    assert origin("action", "NavigateToPose") == "nav2_msgs"
    assert origin("srv", "AddTwoInts") == "example_interfaces"
    assert origin("action", "Count") is None
    assert origin("action", "Nothing") is None
    assert {found.kind for found in definitions(BUILT_IN)} == {"msg", "srv", "action"}
