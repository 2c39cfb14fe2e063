"""Generate reference pages from the code: docs/reference/cli.md, artifacts.md, grammar.md, world_keys.md, recordings.md
and more; and what the page shares with records, src/jacaros/look/page/static/schema.js.

make_reference.py [FOLDER]      FOLDER instead of these folders; a test compares the two
"""

import inspect
import json
import math
import re
import sys
import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import click

import jacaros.agents.mind.actions.standard
from jacaros.agents.mind.actions.internal_action import STANDARD
from jacaros.agents.terms.functions import ARITIES
from jacaros.artifacts import Artifact, describe
from jacaros.look.records.recording import NOWHERE
from jacaros.look.records.records import EVENTS, VERSION
from jacaros.robots.artifacts.motion import WheeledArtifact
from jacaros.robots.kit.ros_artifact import RosArtifact
from jacaros.robots.plane.shapes import Segment
from jacaros.robots.registry import BUILT_IN
from jacaros.robots.world.data import robot, world
from jacaros.robots.world.data.faults import Fault, Progress
from jacaros.robots.world.data.ground_truth import FIELDS, RobotState
from jacaros.runtime.cli.main import COMMANDS, jacaros
from jacaros.runtime.files.entries import declared_entries

ROOT = Path(__file__).resolve().parent.parent
REFERENCE, STATIC = ROOT / "docs" / "reference", ROOT / "src" / "jacaros" / "look" / "page" / "static"
NOTE = "<!-- Written by tools/make_reference.py from the code; change it there. -->\n"
LINKS = {
    "ReadingPolicy": "[reading sensors](#reading-sensors)",
    "WheeledArtifact": "[all artifacts that drive](#all-artifacts-that-drive)",
}
"""Links that replace classes for authors of artifacts."""
ACTIONS = Path("internal_actions")
GROUPS = (
    "beliefs",
    "queries",
    "lists",
    "strings",
    "collections",
    "goals",
    "plans",
    "time",
    "agents",
    "callers",
    "output",
    "functions",
)
"""The pages about internal actions and functions."""
DESCRIBED: dict[str, Any] = {
    "Robot": robot.RobotDescription(),
    "Limits": robot.RobotLimits(),
    "Battery": robot.BatterySettings(),
    "Odometry": robot.OdometrySettings(),
    "Laser": robot.LaserSettings(),
    "Navigation": robot.NavigationSettings(),
    "Tool": robot.CleaningTool("", ()),
    "Door": world.Door("", Segment(0.0, 0.0, 1.0, 0.0)),
    "Object": world.ObjectDescription("", 0.0, 0.0),
    "Person": world.PersonDescription("", ()),
    "Fault": Fault("", ""),
    "Progress": Progress(),
}
"""The parts of world files and fault files whose entries are declared, with their defaults."""
SECTIONS = {"Options:": "Options", "Properties:": "Properties", "Signals:": "Signals"}


def main(folder: Path) -> None:
    """Write the pages."""
    (folder / ACTIONS).mkdir(parents=True, exist_ok=True)
    pages = (
        ("cli.md", command_line()),
        ("artifacts.md", artifacts()),
        ("grammar.md", grammar()),
        ("world_keys.md", world_keys()),
        ("recordings.md", recordings()),
        (ACTIONS / "index.md", internal_actions()),
        (STATIC / "schema.js" if folder == REFERENCE else "schema.js", page_constants()),
    )
    for name, lines in pages:
        (folder / name).write_text("\n".join(lines).rstrip() + "\n", encoding="utf-8")


def command_line() -> Iterator[str]:
    """The page about the command."""
    yield NOTE
    yield "# The command line\n"
    yield (ROOT / "tools" / "cli_contract.md").read_text(encoding="utf-8")
    context = click.Context(jacaros, info_name="jacaros")
    for name in COMMANDS:
        command = jacaros.get_command(context, name)
        assert command is not None
        yield f"## jacaros {name}\n"
        yield f"{inspect.cleandoc(command.help or '')}\n"
        own = click.Context(command, parent=context, info_name=name)
        if isinstance(command, click.Group):
            yield from _parts(command, own)
        else:
            yield from _usage(command, own)


def grammar() -> Iterator[str]:
    """The page with the grammar of the language."""
    yield NOTE
    yield "# The grammar\n"
    yield (ROOT / "tools" / "grammar.md").read_text(encoding="utf-8")
    yield "```ebnf"
    yield (
        (ROOT / "src" / "jacaros" / "agents" / "language" / "grammar.ebnf")
        .read_text(encoding="utf-8")
        .rstrip()
    )
    yield "```"


def recordings() -> Iterator[str]:
    """The page about recordings, with the tables of events."""
    yield NOTE
    yield "# Recordings\n"
    for line in (ROOT / "tools" / "recordings.md").read_text(encoding="utf-8").splitlines():
        if line.startswith("<!-- events"):
            yield "| event | data |\n|---|---|"
        if line == "<!-- events of the world -->":
            yield from (
                f"| `{kind}` | {', '.join(f'`{name}`' for name in names)} |"
                for kind, names in FIELDS.items()
                if kind != "battery"
            )
        elif line.startswith("<!-- events: "):
            for kind in line.removeprefix("<!-- events: ").removesuffix(" -->").split():
                yield f"| `{kind}` | {' '.join((EVENTS[kind].__doc__ or '').split())} |"
        else:
            yield line


def page_constants() -> Iterator[str]:
    """The module of the page with what it shares with the readers in Python."""
    yield "// Written by tools/make_reference.py from the code; change it there.\n"
    yield f"/** The version of recordings that this page knows. */\nexport const VERSION = {VERSION};\n"
    fields = json.dumps(RobotState._fields)
    yield f"/** The fields of a robot's row in a frame, in their order. */\nexport const ROBOT_STATE = {fields};\n"
    empty = json.dumps({**NOWHERE, "bounds": None}, indent=2)
    yield f"/** The drawing of an unknown world. */\nexport const EMPTY = {empty};"


def world_keys() -> Iterator[str]:
    """The page with the keys of world files and fault files."""
    yield NOTE
    yield "# Keys of world files and fault files\n"
    yield (ROOT / "tools" / "world_keys.md").read_text(encoding="utf-8")
    for title, usual in DESCRIBED.items():
        yield f"## {title}\n"
        yield "| key | values | default | meaning |\n|---|---|---|---|"
        for key, (name, entry, required) in declared_entries(usual).items():
            default = "required" if required else _default(getattr(usual, name), entry.words)
            yield f"| `{key}` | {entry.words} | {default} | {entry.help} |"
        yield ""


def _default(value: object, words: str) -> str:
    """Return the default of a key as it is written in a file."""
    if isinstance(value, bool):
        return words.split(", ")[value]
    if isinstance(value, int | float) and "flag" not in words:
        return f"{math.degrees(value) if words[-1] == '°' or '°/s' in words else value:.4g}"
    return f"`{value}`" if value and isinstance(value, str) else ""


def _parts(group: click.Group, context: click.Context) -> Iterator[str]:
    """The commands of a command, with the usage of each."""
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        assert command is not None
        yield f"### {context.command_path} {name}\n"
        yield f"{inspect.cleandoc(command.help or '')}\n"
        yield from _usage(command, click.Context(command, parent=context, info_name=name))


def _usage(command: click.Command, context: click.Context) -> Iterator[str]:
    yield f"```text\n{command.get_usage(context)}\n```\n"
    options = [each for each in command.params if isinstance(each, click.Option)]
    if options:
        yield "| option | meaning |\n|---|---|"
        yield "\n".join(map(_option, options)) + "\n"
    if command.epilog:
        _, _, examples = command.epilog.partition("Examples:\n")
        yield f"```sh\n{textwrap.dedent(examples)}\n```\n"


def _option(option: click.Option) -> str:
    """A row of a table. Written here, so that it does not depend on the version of Click."""
    if isinstance(option.type, click.Choice):
        value = " " + "\\|".join(map(str, option.type.choices))
    else:
        value = "" if option.is_flag else f" {option.metavar or 'N'}"
    default = (
        f" Default: `{option.default}`."
        if option.show_default and "(default:" not in (option.help or "")
        else " Required."
        if option.required
        else ""
    )
    if option.show_envvar:
        default += f" Environment variable: `{option.envvar}`."
    names = "`, `".join([f"{option.opts[0]}{value}", *option.secondary_opts])
    return f"| `{names}` | {_cell(option.help or '')}{default} |"


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")


def internal_actions() -> Iterator[str]:
    """The index of internal actions and functions: links to their entries, and their properties from the registry."""
    yield NOTE
    yield "# Internal actions and functions\n"
    yield (ROOT / "tools" / "internal_actions.md").read_text(encoding="utf-8")
    for group in GROUPS:
        text = (ROOT / "docs" / "reference" / ACTIONS / f"{group}.md").read_text(encoding="utf-8")
        links = dict(_described(group, text))
        yield f"## {text.partition(chr(10))[0].removeprefix('# ')}\n"
        rows = _function_rows(links) if group == "functions" else _action_rows(links)
        yield "\n".join(rows) + "\n"


def _described(group: str, text: str) -> Iterator[tuple[str, str]]:
    """Yield each name that a page describes, in a section of its own or in a row of a table, and a link to it."""
    title = ""
    for line in text.splitlines():
        if heading := re.fullmatch(r"## (.+)", line):
            title = heading[1]
        row = re.match(r"\| `([.\w]+)", line)
        name = title if heading else row[1] if row and title[:1].isupper() else ""
        if re.fullmatch(r"\.?[a-z][.\w]*", name):
            anchor = re.sub(r"[^\w-]", "", title.lower().replace(" ", "-"))
            yield name, f"[`{name}`]({group}.md#{anchor})"


def _action_rows(links: dict[str, str]) -> Iterator[str]:
    yield "| internal action | arguments | answers | acts | in contexts |\n|---|---|---|---|---|"
    for name, link in links.items():
        action = STANDARD[name]
        answers = "several" if action.backtracks else "one"
        acts = "yes" if action.suspends else "no"
        contexts = "no" if action.body_only else "yes"
        arguments = _arguments(action.minimum, math.inf if action.maximum is None else action.maximum)
        yield f"| {link} | {arguments} | {answers} | {acts} | {contexts} |"


def _function_rows(links: dict[str, str]) -> Iterator[str]:
    yield "| function | arguments |\n|---|---|"
    for name, link in links.items():
        yield f"| {link} | {_arguments(*ARITIES[name])} |"


def _arguments(least: float, most: float) -> str:
    if least == most:
        return str(least)
    return f"{least} or more" if most == math.inf else f"{least} to {most}"


def artifacts() -> Iterator[str]:
    """The page about the ready-made artifacts."""
    yield NOTE
    yield "# Ready-made artifacts\n"
    yield (ROOT / "tools" / "artifacts.md").read_text(encoding="utf-8")
    yield "## All artifacts for robots\n"
    yield from _documentation(RosArtifact)
    yield "## All artifacts that drive\n"
    yield from _documentation(WheeledArtifact)
    for name in sorted(BUILT_IN):
        yield f"## {name}\n"
        yield from _documentation(BUILT_IN[name])
        yield from _operations(BUILT_IN[name])


def _operations(artifact_type: type[Artifact]) -> Iterator[str]:
    own = [each for each in describe(artifact_type).operations if each.kind == "operation"]
    shared = _shared_with(artifact_type)
    if shared is not None:
        inherited = {each.usage for each in describe(shared).operations}
        own = [each for each in own if each.usage not in inherited]
        yield f"It has all operations of [{shared.__name__}](#{shared.__name__.lower()}).\n"
    if own:
        yield "| operation | effect |\n|---|---|"
        rows = [
            f"| `{_cell(each.usage)}` | {_cell(_prose(each.text))} |"
            for each in sorted(own, key=lambda o: o.usage)
        ]
        yield "\n".join(rows) + "\n"


def _shared_with(artifact_type: type[Artifact]) -> type[Artifact] | None:
    """The nearest ready-made artifact that *artifact_type* extends."""
    return next((each for each in artifact_type.__mro__[1:] if each.__name__ in BUILT_IN), None)


def _documentation(artifact_type: type[Artifact]) -> Iterator[str]:
    """The docstring of a class as Markdown, without the parts for authors of artifacts."""
    for part in inspect.cleandoc(artifact_type.__doc__ or "").split("\n\n"):
        head, _, rest = part.partition("\n")
        if head in ("Attributes:",) or part.startswith("A subclass"):
            continue
        if head in SECTIONS:
            yield f"{SECTIONS[head]}:\n"
            yield "\n".join(_entries(rest)) + "\n"
        else:
            yield f"{_prose(part)}\n"


def _entries(text: str) -> Iterator[str]:
    """The entries of a section. Indented lines continue the entry before."""
    entries: list[str] = []
    for line in textwrap.dedent(text).splitlines():
        if line.startswith(" ") and entries:
            entries[-1] += " " + line.strip()
        else:
            entries.append(line.strip())
    for entry in entries:
        name, colon, meaning = entry.partition(": ")
        yield f"* `{name}`: {_prose(meaning)}" if colon else f"* {_prose(entry)}"


def _prose(text: str) -> str:
    """Convert the markup of docstrings to Markdown."""
    text = re.sub(r"``([^`]+)``", r"`\1`", text).replace(".  ", ". ")
    for name, link in LINKS.items():
        text = text.replace(f"`{name}`", link)
    return re.sub(r"(?<![\w*])\*(\w+)\*(?![\w*])", r"`\1`", text)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs" / "reference")
