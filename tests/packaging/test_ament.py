"""The repository as an ament_python package: what colcon would require, without colcon."""

import ast
import shutil
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

from jacaros.version import VERSION

ROOT = Path(__file__).parents[2]


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """A copy of the source tree, for `setup.py` writes beside itself."""
    copy = tmp_path / "tree"
    copy.mkdir()
    for name in ("pyproject.toml", "setup.cfg", "setup.py", "package.xml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, copy)
    shutil.copytree(ROOT / "resource", copy / "resource")
    shutil.copytree(ROOT / "src", copy / "src", ignore=shutil.ignore_patterns("__pycache__", "*.egg-info"))
    return copy


def setup(tree: Path, *arguments: str) -> str:
    """Call `setup.py` as colcon does; the last line of its output."""
    call = [sys.executable, "-W", "ignore", "setup.py", *arguments]
    done = subprocess.run(call, cwd=tree, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return (done.stdout.strip().splitlines() or [""])[-1]


def test_package_xml_declares_an_ament_python_package() -> None:
    package = ElementTree.parse(ROOT / "package.xml").getroot()
    assert package.get("format") == "3"
    assert package.findtext("name") == "jacaros"
    assert package.findtext("license") == "Apache-2.0"
    assert package.find("maintainer").get("email")  # type: ignore[union-attr]
    assert package.findtext("export/build_type") == "ament_python"


@pytest.mark.ros2
def test_package_xml_is_what_the_ros_tools_expect(request: pytest.FixtureRequest) -> None:
    if not request.config.getoption("--require-ros2"):
        pytest.importorskip("catkin_pkg", reason="no catkin_pkg here; it comes with the ROS 2 build tools")
    from catkin_pkg.package import parse_package

    warnings: list[str] = []
    parse_package(str(ROOT), warnings=warnings)
    assert warnings == []


def test_setup_py_contains_the_package(tree: Path) -> None:
    assert setup(tree, "--name") == "jacaros"
    assert setup(tree, "--version") == VERSION


READING = """
import setuptools
from distutils.core import run_setup
dist = run_setup("setup.py", script_args=("--dry-run",), stop_after="config")
skipped = ("cmdclass", "distclass", "ext_modules", "metadata", *dist.display_option_names)
data = {key: value for key, value in vars(dist).items() if key[0] != "_" and not callable(value) and key not in skipped}
skipped = ("license_files", "provides_extras")
data["metadata"] = {key: value for key, value in vars(dist.metadata).items() if key not in skipped}
print(repr(data))
"""
"""What colcon runs to learn about a package (colcon-python-setup-py 0.2.9), in few words."""


def test_setup_py_uses_literals(tree: Path) -> None:
    call = [sys.executable, "-W", "ignore", "-c", READING]
    done = subprocess.run(call, cwd=tree, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    data = ast.literal_eval(done.stdout.splitlines()[-1])
    assert data["metadata"]["name"] == "jacaros"
    assert data["python_requires"] == ">=3.11"
    assert ("share/jacaros", ["package.xml"]) in data["data_files"]


@pytest.mark.slow
def test_an_installation_by_setup_py_has_the_places_of_ros(tree: Path, tmp_path: Path) -> None:
    prefix = tmp_path / "install"
    record = tmp_path / "installed.txt"
    setup(tree, "egg_info", "--egg-base", str(tmp_path), "build", "--build-base", str(tmp_path / "build"),
          "install", "--prefix", str(prefix), "--record", str(record), "--single-version-externally-managed")  # fmt: skip
    assert (prefix / "share/ament_index/resource_index/packages/jacaros").is_file()
    assert (prefix / "share/jacaros/package.xml").is_file()
    assert (prefix / "lib/jacaros/jacaros").is_file(), "where `ros2 run jacaros jacaros` looks"
    assert list(prefix.glob("**/jacaros/robots/world/worlds/patrol.yaml"))
