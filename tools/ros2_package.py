"""ROS 2 packages made from the definitions of JaCaROS, for installations that lack the original packages.

    python tools/ros2_package.py FOLDER

writes ``FOLDER/jacaros_interfaces``, ready for ``colcon build``. That one package contains a substitute for every
type here that ROS 2 has, whatever its package: ``nav2_msgs/action/NavigateToPose`` becomes
``jacaros_interfaces/action/NavigateToPose``. One package instead of one per robot builds in a fraction of the time,
and it cannot hide or break an original one that is installed later. With ``tf2_msgs`` as a second argument that
package is written instead, under its own name: the topic ``/tf`` is only useful with the type that all other nodes
use.
"""

import argparse
import re
import shutil
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from jacaros.robots.ros.interfaces import BUILT_IN, KINDS, NOT_SUBSTITUTED
from jacaros.robots.ros.interfaces import SUBSTITUTES as PACKAGE

_REFERENCE = re.compile(r"^[ \t]*(?P<package>[a-z]\w*)/(?:msg/)?(?P<name>\w+)", re.MULTILINE)

_CONSTANT = re.compile(r"\s*\w+\s+[A-Z][A-Z0-9_]*\s*=.*")


@dataclass(frozen=True)
class DefinitionFile:
    """A definition file.

    Attributes:
        package, kind, name: the parts of the type's name.
        path: the file.
    """

    package: str
    kind: str
    name: str
    path: Path

    @property
    def relative(self) -> str:
        """Its path in its package."""
        return f"{self.kind}/{self.path.name}"


def definitions(root: Path = BUILT_IN) -> Iterator[DefinitionFile]:
    """Yield all definitions below *root*, sorted by name."""
    for path in sorted(root.glob("*/*/*.*")):
        kind = path.parent.name
        if kind in KINDS and path.suffix == f".{kind}":
            yield DefinitionFile(path.parent.parent.name, kind, path.stem, path)


def similar_types(root: Path = BUILT_IN) -> dict[str, DefinitionFile]:
    """Return the definitions in `PACKAGE`, by their paths in it.

    Raises:
        ValueError: two packages have different types of one name.
    """
    found: dict[str, DefinitionFile] = {}
    for definition in definitions(root):
        if definition.package in NOT_SUBSTITUTED:
            continue
        other = found.setdefault(definition.relative, definition)
        if _meaning(other) != _meaning(definition):
            raise ValueError(f"{other.path} and {definition.path} would have the same name in {PACKAGE}")
    return found


def write_package(folder: Path, package: str = PACKAGE, root: Path = BUILT_IN) -> Path:
    """Write a package below *folder*, replacing an earlier one, and return its path."""
    if package == PACKAGE:
        chosen = similar_types(root)
    else:
        chosen = {found.relative: found for found in definitions(root) if found.package == package}
    if not chosen:
        raise ValueError(f"no definitions of {package} in {root}")
    ours = {found.package for found in chosen.values()}
    target = folder / package
    shutil.rmtree(target, ignore_errors=True)
    depends: set[str] = set()
    for relative, definition in chosen.items():
        text = definition.path.read_text(encoding="utf-8")
        depends |= {match["package"] for match in _REFERENCE.finditer(text)} - ours
        file = target / relative
        file.parent.mkdir(parents=True, exist_ok=True)
        _write(file, _without_repeated_constants(_with_own_references(text, ours)))
    if any(found.kind == "action" for found in chosen.values()):
        depends.add("action_msgs")
    _write(target / "CMakeLists.txt", _cmake(package, sorted(chosen), sorted(depends)))
    _write(target / "package.xml", _manifest(package, sorted(depends)))
    return target


def _write(file: Path, text: str) -> None:
    file.write_text(text, encoding="utf-8", newline="\n")


def _meaning(definition: DefinitionFile) -> list[str]:
    """Return the lines of a definition, without comments."""
    lines = definition.path.read_text(encoding="utf-8").splitlines()
    return [line for line in (line.split("#")[0].strip() for line in lines) if line]


def _with_own_references(text: str, ours: set[str]) -> str:
    """Make references between the combined packages refer to the one package."""

    def own(match: re.Match[str]) -> str:
        return match["name"] if match["package"] in ours else match[0]

    return _REFERENCE.sub(own, text)


def _without_repeated_constants(text: str) -> str:
    """Remove constants that also appear in an earlier part of the definition: rosidl_parser assigns both to one part.

    Two types match whatever their constants are, so a substitute can omit them.
    """
    parts: list[list[str]] = [[]]
    seen: set[str] = set()
    for line in text.splitlines():
        if line.strip() == "---":
            seen |= {earlier.strip() for earlier in parts[-1] if _CONSTANT.fullmatch(earlier)}
            parts.append([])
        elif line.strip() not in seen:
            parts[-1].append(line)
    return "\n---\n".join("\n".join(lines) for lines in parts) + "\n"


def _cmake(package: str, files: list[str], depends: list[str]) -> str:
    lines = [
        "cmake_minimum_required(VERSION 3.8)",
        f"project({package})",
        "",
        "find_package(ament_cmake REQUIRED)",
        "find_package(rosidl_default_generators REQUIRED)",
        *(f"find_package({name} REQUIRED)" for name in depends),
        "",
        "rosidl_generate_interfaces(${PROJECT_NAME}",
        *(f'  "{file}"' for file in files),
        *([f"  DEPENDENCIES {' '.join(depends)}"] if depends else []),
        ")",
        "",
        "# The same headers are read for every type and cost more than the types do: read them once.",
        "foreach(part rosidl_typesupport_fastrtps_c rosidl_typesupport_fastrtps_cpp rosidl_generator_py)",
        "  if(TARGET ${PROJECT_NAME}__${part})",
        "    set_target_properties(${PROJECT_NAME}__${part} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 50)",
        "  endif()",
        "endforeach()",
        "",
        "ament_export_dependencies(rosidl_default_runtime)",
        "ament_package()",
    ]
    return "\n".join(lines) + "\n"


def _manifest(package: str, depends: list[str]) -> str:
    lines = [
        '<?xml version="1.0"?>',
        '<package format="3">',
        f"  <name>{package}</name>",
        "  <version>0.1.0</version>",
        "  <description>Interfaces that JaCaROS uses where a ROS 2 installation lacks them</description>",
        '  <maintainer email="jacaros@users.noreply.example.org">The JaCaROS authors</maintainer>',
        "  <license>Apache-2.0</license>",
        "  <buildtool_depend>ament_cmake</buildtool_depend>",
        "  <buildtool_depend>rosidl_default_generators</buildtool_depend>",
        *(f"  <depend>{name}</depend>" for name in depends),
        "  <exec_depend>rosidl_default_runtime</exec_depend>",
        "  <member_of_group>rosidl_interface_packages</member_of_group>",
        "  <export>",
        "    <build_type>ament_cmake</build_type>",
        "  </export>",
        "</package>",
    ]
    return "\n".join(lines) + "\n"


def main() -> None:
    """Write a package to the folder on the command line."""
    parser = argparse.ArgumentParser(description="Write a ROS 2 package of interfaces, ready to be built.")
    parser.add_argument("folder", type=Path, help="where to put the package, such as the src of a workspace")
    parser.add_argument("package", nargs="?", default=PACKAGE, choices=(PACKAGE, "tf2_msgs"))
    arguments = parser.parse_args()
    print(write_package(arguments.folder, arguments.package))


if __name__ == "__main__":
    main()
