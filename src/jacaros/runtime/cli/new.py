"""``jacaros new NAME``: a project that runs, from a template."""

import keyword
import os
import re
from collections.abc import Iterator
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path, PurePosixPath

import click

from jacaros.runtime.cli.options import PATH, option
from jacaros.runtime.cli.usage import examples, usage_error

TEMPLATES = ("robot", "agents", "jason", "ros2-package")
_SHARED = "common"
_HERE = PurePosixPath()
_PLACEHOLDER = "my_project"
_NAME = re.compile(r"[a-z][a-z0-9_]*")
"""Names that are an identifier in a project file, a Python package and a ROS package."""


@click.command(
    "new",
    epilog=examples(
        "jacaros new my_robot",
        "jacaros new my_agents --template agents",
    ),
)
@click.argument("path", metavar="NAME", type=PATH)
@option("--template", "What to begin with.", click.Choice(TEMPLATES), default="robot")
def command(path: Path, template: str) -> None:
    """Make a project NAME in a new folder of that name: programs, a test, a CI file and editor settings.

    Templates: a `robot` in a simulated room, `agents` that share an artifact, a project of `jason`, and a `ros2-package`.
    """  # fmt: skip
    _check(path)
    try:
        path.mkdir(parents=True)
        for file, text in project_files(path.name, template):
            target = path / file
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text, encoding="utf-8")
    except OSError as error:
        raise usage_error(f"cannot write `{path}`: {error.strerror}", "name another folder") from error
    click.echo(f"made {path}; continue with `cd {path}` and the commands in README.md")


def _check(path: Path) -> None:
    """Check that the project can have this name, and that its folder is new.

    Raises:
        UsageError: the name is not an identifier, or the folder exists.
    """
    if not _NAME.fullmatch(path.name) or keyword.iskeyword(path.name):
        possible = re.sub(r"\W+", "_", path.name.lower(), flags=re.ASCII).strip("_")
        usable = _NAME.fullmatch(possible) and not keyword.iskeyword(possible)
        raise usage_error(
            f"invalid name of a project: `{path.name}`; expected lower-case letters, digits and underscores",
            f"jacaros new {path.parent / (possible if usable else 'my_robot')}",
        )
    if os.path.lexists(path):
        raise usage_error(f"`{path}` already exists", "choose another name, or delete it")


def project_files(name: str, template: str) -> Iterator[tuple[PurePosixPath, str]]:
    """Yield the path and text of each file of a new project.

    Args:
        name: of the project.
        template: one of `TEMPLATES`.
    """
    root = files("jacaros") / "templates"
    own = dict(_below(root / template))
    suffix = next(path.suffix for path in own if path.stem == _PLACEHOLDER and path.suffix)
    for path, text in ({**dict(_below(root / _SHARED)), **own}).items():
        # A file of the package cannot be hidden, and is not code of the package: dot_vscode, setup.py-tpl.
        parts = (part.removesuffix("-tpl").replace(_PLACEHOLDER, name) for part in path.parts)
        target = PurePosixPath(*(re.sub("^dot_", ".", part) for part in parts))
        yield target, text.replace("my_project.SUFFIX", f"my_project{suffix}").replace(_PLACEHOLDER, name)


def _below(folder: Traversable, path: PurePosixPath = _HERE) -> Iterator[tuple[PurePosixPath, str]]:
    for each in sorted(folder.iterdir(), key=lambda entry: entry.name):
        inside = path / each.name
        if each.is_dir():
            yield from _below(each, inside)
        else:
            yield inside, each.read_text(encoding="utf-8")
