"""The kinds of files that `fuzz.py` mutates, and their readers, which accept a file or reject it with their own error.

Valid files are the seeds. Their bytes, words, lines and, for JSON and CBOR, values are changed.
"""

import json
import re
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from random import Random
from typing import Any

import cbor2
from pygls.workspace import PositionCodec

from jacaros.agents.language.diagnostics import SourceFile, render_all
from jacaros.editors.lsp import fixes
from jacaros.editors.lsp.answers import Answers
from jacaros.editors.lsp.colours import colours
from jacaros.editors.lsp.editing import formatting
from jacaros.editors.lsp.outline import folds, outline_of
from jacaros.editors.lsp.outline import symbols as symbols_in_outline
from jacaros.editors.lsp.projects import Projects
from jacaros.editors.symbols import navigation
from jacaros.editors.symbols.completion import completions
from jacaros.editors.symbols.descriptions import hover
from jacaros.editors.symbols.hints import hints
from jacaros.editors.symbols.index import Index
from jacaros.editors.symbols.model import Position, RenameRefused
from jacaros.editors.symbols.renaming import rename
from jacaros.editors.symbols.yaml_keys import yaml_completions, yaml_hover
from jacaros.look.page.page import replay_html
from jacaros.look.page.recorder import Recorder
from jacaros.look.page.scene import RobotView
from jacaros.look.records.recording import Recording
from jacaros.robots.mapping.file import load_mapping
from jacaros.robots.ros.drivers.rosbridge.link import RosbridgeLink
from jacaros.robots.ros.parameter import checked_value
from jacaros.robots.ros.protocols.rosbridge_messages import Translator
from jacaros.robots.ros.typestore import DefinitionSchema
from jacaros.robots.world.data.ground_truth import GroundTruth, PathSample
from jacaros.robots.world.files.world import load_world
from jacaros.runtime.cli.ros_arguments import read_parameters
from jacaros.runtime.errors import JacarosError
from jacaros.runtime.mas.checks.files import check_files
from jacaros.runtime.mas.launch import load_deployment

ROOT = Path(__file__).resolve().parent.parent
SECONDS = 20.0
"""Maximum processor time for a file, in seconds."""
LONGEST = 200_000
"""Maximum number of characters of all messages about a file."""

_PIECE = re.compile(rb"[A-Za-z_][\w.]*|\d+|\s+|.", re.DOTALL)
ODD = (
    *(
        b"\0",
        b"\x07",
        b"\x1b[2J",
        b"\r",
        b"\n",
        b"\t",
        b"\xff",
        b"\xed\xa0\x80",
        "\u2028\u202e\ufeff日𝄞".encode(),
    ),
    *(
        b"[" * 3000,
        b"{" * 3000,
        b"(" * 300,
        b'"',
        b"'",
        b"/*",
        b"*/",
        b"//",
        b"#",
        b"---\n",
        b"...\n",
        b"\\",
        b"\\u12",
    ),
    *(
        b"&a [*a]",
        b"*a",
        b"&b {x: 1}",
        b"<<: *b",
        b"!!int x",
        b"!!binary '='",
        b"!foo {a: 1}",
        b"!!set {a}",
        b"2001-99-99",
    ),
    *(
        b"x" * 5000,
        b"9" * 5000,
        b"1e999",
        b"-0",
        b".nan",
        b".inf",
        b"null",
        b"~",
        b"true",
        b"[]",
        b"{}",
        b": ",
        b"- ",
        b"? ",
    ),
    *(b"NaN", b"Infinity", b"{{RECORDING}}", b"</script>", b"${", b"%s", b"../" * 100),
)
VALUES: tuple[Any, ...] = (
    *(
        None,
        True,
        False,
        0,
        -1,
        1.5,
        1e308,
        float("nan"),
        float("inf"),
        10**400,
        "",
        "x" * 3000,
        "\0\x1b[2J",
        "{{RECORDING}}",
    ),
    *([], {}, [[]], {"": None}, [1, "a", None], "</script>", "../../etc", [0] * 1000),
)


@dataclass(frozen=True)
class FileKind:
    """A kind of file.

    Attributes:
        suffix: suffix of file names.
        seeds: valid files.
        read: reads a file; any exception other than a `JacarosError`, whose text is shown to users, is a finding.
        tree: changes values of a file, if it has any.
    """

    suffix: str
    seeds: Callable[[], Sequence[bytes]]
    read: Callable[[Path, bytes], object]
    tree: Callable[[bytes, Random], bytes] | None = None

    def made(self, random: Random) -> tuple[str, bytes]:
        """Return how a file is made, and the file."""
        seeds = _seeds(self)
        data = random.choice(seeds)
        hows = [_bytes_changed, _pieces_changed, _pieces_changed, _lines_changed, _spliced]
        changed: list[Callable[..., bytes]] = [*hows, *(3 * [self.tree] if self.tree is not None else [])]
        for _ in range(random.choice((1, 1, 1, 2, 3, 8))):
            how = random.choice(changed)
            data = how(data, random, seeds) if how is _spliced else how(data, random)
        return "changed", data

    def examine(self, data: bytes, folder: Path) -> str:
        """Read a file; return ``taken`` or ``refused``. An exception is a finding."""
        path = folder / f"fuzz{self.suffix}"
        path.write_bytes(data)
        try:
            told = self.read(path, data)
        except JacarosError as wrong:
            told, outcome = str(wrong), "refused"
        else:
            outcome = "taken"
        if isinstance(told, str):
            assert len(told) <= min(LONGEST, 20_000 + 50 * len(data)), f"{len(told)} characters of messages"
            assert not re.search("[\x00-\x08\x0e-\x1f\x7f-\x9f\u202a-\u202e]", told), "raw control characters"
            told.encode()
        return outcome


@cache
def _seeds(kind: FileKind) -> Sequence[bytes]:
    return kind.seeds()


# changes


def _bytes_changed(data: bytes, random: Random) -> bytes:
    at = random.randint(0, len(data))
    put = random.choice(
        (random.choice(ODD), random.randbytes(random.choice((1, 1, 4))), data[at : at + 9] * 2)
    )
    return data[:at] + put + data[at + random.choice((0, 0, 1, len(put), 50)) :]


def _pieces_changed(data: bytes, random: Random) -> bytes:
    pieces = _PIECE.findall(data) or [b""]
    at, other = random.randrange(len(pieces)), random.randrange(len(pieces))
    length = random.choice((1, 1, 2, 5, 20))
    match random.randrange(5):
        case 0:
            del pieces[at : at + length]
        case 1:
            pieces[other:other] = pieces[at : at + length]
        case 2:
            pieces[at], pieces[other] = pieces[other], pieces[at]
        case 3:
            pieces.insert(at, random.choice(ODD))
        case _:
            pieces[at] = random.choice(ODD)
    return b"".join(pieces)


def _lines_changed(data: bytes, random: Random) -> bytes:
    lines = data.split(b"\n")
    at, other = random.randrange(len(lines)), random.randrange(len(lines))
    match random.randrange(5):
        case 0:
            del lines[at]
        case 1:
            lines[at], lines[other] = lines[other], lines[at]
        case 2:
            lines[at] = b" " * random.choice((1, 2, 7)) + lines[at]
        case 3:
            lines[at : at + 1] = [lines[at]] * random.choice((2, 30))
        case _:
            head, colon, _ = lines[at].partition(b":")
            lines[at] = head + colon + b" " + random.choice(ODD)
    return b"\n".join(lines)


def _spliced(data: bytes, random: Random, seeds: Sequence[bytes]) -> bytes:
    other = random.choice(seeds)
    return data[: random.randint(0, len(data))] + other[random.randint(0, len(other)) :]


def _value_changed(value: Any, random: Random) -> Any:
    """Return a JSON value with one of its parts changed."""
    if isinstance(value, dict) and value and random.random() < 0.85:
        key = random.choice(list(value))
        if random.random() < 0.1:
            return {name: each for name, each in value.items() if name != key}
        if random.random() < 0.1:
            return {**value, random.choice((f"{key}x", "", "\x1b")): value[key]}
        return {**value, key: _value_changed(value[key], random)}
    if isinstance(value, list) and value and random.random() < 0.85:
        at = random.randrange(len(value))
        changed = random.choice(([], [value[at]] * 2, [_value_changed(value[at], random)]))
        return [*value[:at], *changed, *value[at + 1 :]]
    if random.random() < 0.02:
        return _nested(random.choice((50, 3000)))
    return random.choice(VALUES)


def _nested(depth: int) -> Any:
    value: Any = []
    for _ in range(depth):
        value = [value]
    return value


def _json_lines_changed(data: bytes, random: Random) -> bytes:
    lines = data.split(b"\n")
    at = random.randrange(len(lines))
    try:
        lines[at] = json.dumps(_value_changed(json.loads(lines[at]), random)).encode()
    except (ValueError, RecursionError):
        lines[at] = random.choice(ODD)
    return b"\n".join(lines)


def _cbor_changed(data: bytes, random: Random) -> bytes:
    """Change values of a frame of either notation, and possibly its notation."""
    try:
        value = _frame(data)
    except Exception:  # not a valid frame: change its bytes
        return data + random.randbytes(8)
    changed = _value_changed(value, random)
    try:
        return cbor2.dumps(changed) if random.random() < 0.5 else json.dumps(changed).encode()
    except (RecursionError, ValueError, TypeError):
        return data


def _frame(data: bytes) -> Any:
    return json.loads(data) if data[:1] in b"{[" else cbor2.loads(data)


# seeds and readers


def _files(*patterns: str) -> list[bytes]:
    paths = [path for pattern in patterns for path in sorted(ROOT.glob(pattern))]
    assert paths, patterns
    return [path.read_bytes() for path in paths]


def _programs() -> list[bytes]:
    return [data for data in _files("examples/**/*.asl", "tests/compatibility/**/*.asl") if len(data) < 5000]


def _read_program(path: Path, _: bytes) -> str:
    return render_all(check_files([path]).diagnostics)


def _read_project(path: Path, _: bytes) -> object:
    diagnostics = check_files([path]).diagnostics
    load_deployment(path)
    return render_all(diagnostics)


def _read_mapping(path: Path, _: bytes) -> object:
    told = render_all(check_files([path]).diagnostics)
    load_mapping(path)
    return told


def _read_world(path: Path, _: bytes) -> None:
    json.dumps(load_world(str(path)).drawing())


@cache
def _projects_in(folder: Path) -> Projects:
    return Projects([folder])


def _ask_as_editor(path: Path, data: bytes) -> object:
    """Ask the language server's functions everything about a text that is not saved."""
    path = path.resolve()
    text = data.decode("utf-8", "replace").replace("\r\n", "\n").replace("\r", "\n")
    projects = _projects_in(path.parent)
    found = projects.update([path], {path: text})
    projects.index({path: text})
    units = projects.units_of(path)
    index = next((each.index for each in units if each.index is not None), Index())
    file = SourceFile(units[0].name_of(path) if units else path.as_posix(), text)
    told = []
    for each in found.get(path, ()):
        told += [action.title for action in fixes.actions(each, "uri", _CODEC, path.suffix == ".asl")]
    answers = Answers(file, _CODEC)
    outline = outline_of(file)
    told.append(
        repr((symbols_in_outline(outline, answers.positions), folds(file, outline), formatting(file)))
    )
    if path.suffix == ".asl":
        told.append(repr((colours(file, answers.positions), hints(index, file))))
    _ask_at_places(index, file, answers)
    return "".join(told)[:LONGEST]


def _ask_at_places(index: Index, file: SourceFile, answers: Answers) -> None:
    random = Random(len(file.text))
    for _ in range(8):
        line = random.randint(1, len(file.lines))
        at = Position(line, random.randint(1, len(file.lines[line - 1]) + 1))
        if file.name.endswith(".asl"):
            proposals = completions(index, file, at)
        else:
            proposals = yaml_completions(file, at)
            yaml_hover(file, at)
        for proposal in proposals:
            answers.completion(proposal)
        if file.name.endswith((".yaml", ".yml")):
            continue
        hover(index, file, at)
        answers.places(navigation.definitions(index, file, at))
        answers.places(each.span for each in navigation.references(index, file, at))
        navigation.highlights(index, file, at)
        with suppress(RenameRefused):
            answers.edit(rename(index, file, at, "other_name"))


_CODEC = PositionCodec()
_PARAMETERS = (
    b"/**:\n  ros__parameters:\n    speed: 0.4\n    places: [hall, kitchen]\n",
    b"robot:\n  guard:\n    ros__parameters: {wheels: {left: {radius: 0.1}, right: &r {radius: 0.1}}, other: *r}\n",
    b"/*/guard:\n  ros__parameters:\n    name: 'a:=b'\n    on: true\n    id: 0x10\n",
    b"speed:=0.5",
    b"wheels:={left: {radius: 0.1}}",
)


def _read_parameters(path: Path, data: bytes) -> None:
    written = (data.decode("utf-8", "surrogateescape"),) if b":=" in data.partition(b"\n")[0] else ()
    for value in read_parameters(written, () if written else (path,), "/robot/guard").values():
        checked_value(value)


def _recordings() -> list[bytes]:
    recorder = Recorder(Path("seed.jsonl"))
    recorder.world(load_world("patrol").drawing())
    for t in range(5):
        recorder.frame(float(t), [RobotView("turtlebot", 0.1 * t, 0.0, 0.0, 90.0)])
        recorder.text(float(t), "patrol", f"corner {t}")
        recorder.event(float(t), "goal", {"agent": "patrol", "goal": "patrol", "at": t})
    recorder.close()
    return [Path("seed.jsonl").read_bytes()]


def _read_recording(path: Path, _: bytes) -> None:
    recording = Recording.read(path)
    replay_html(recording)


def _ground_truths() -> list[bytes]:
    world = load_world("patrol").drawing()
    records = [
        {"kind": "world", "world": world, "seed": 1, "epoch": 0.0},
        {"kind": "sample", "robot": "turtlebot"}
        | dict.fromkeys(PathSample._fields, 1.0)
        | {"charging": False, "touching": False},
        {
            "kind": "event",
            "event": "docked",
            "time": 1.0,
            "robot": "turtlebot",
            "x": 0.0,
            "y": 0.0,
            "yaw": 0.0,
            "data": {},
        },
    ]
    return ["\n".join(json.dumps(each) for each in records).encode()]


def _read_ground_truth(path: Path, _: bytes) -> None:
    GroundTruth.read(path)


_SCAN = {
    "header": {"frame_id": "laser", "stamp": {"sec": 1, "nanosec": 2}},
    "ranges": [1.0, None],
    "angle_min": -1.0,
}
_FRAMES: tuple[dict[str, Any], ...] = (
    {"op": "publish", "topic": "/scan", "msg": _SCAN},
    {"op": "service_response", "id": "1", "service": "/s", "values": {"a": [1]}, "result": True},
    {"op": "status", "level": "error", "msg": "no", "id": "x"},
    {"op": "action_feedback", "id": "goal", "values": {"a": 1}},
)


def _frames() -> list[bytes]:
    return [json.dumps(each).encode() for each in _FRAMES] + [cbor2.dumps(each) for each in _FRAMES]


_TRANSLATOR = Translator(DefinitionSchema())


def _read_frame(_: Path, data: bytes) -> str:
    told: list[str] = []
    taken: list[dict[str, Any]] = []
    link = RosbridgeLink("ws://robot.example", lambda: None, lambda: None, taken.append, told.append)
    link.received(data, data[:1] not in (b"{", b"["))
    for message in taken:
        try:
            _TRANSLATOR.decode("sensor_msgs/msg/LaserScan", message.get("msg"))
        except ValueError as wrong:
            told.append(str(wrong))
    return "".join(told)


def _mappings_and_worlds() -> list[bytes]:
    return list(_files("src/jacaros/robots/mappings/*.yaml", "src/jacaros/robots/world/worlds/*.yaml"))


KINDS = {
    "asl": FileKind(".asl", _programs, _read_program),
    "jcm": FileKind(".jcm", lambda: _files("examples/**/*.jcm", "tests/**/*.jcm"), _read_project),
    "mas2j": FileKind(
        ".mas2j", lambda: _files("examples/**/*.mas2j", "tests/compatibility/*.mas2j"), _read_project
    ),
    "edited-asl": FileKind(".asl", _programs, _ask_as_editor),
    "edited-jcm": FileKind(
        ".jcm", lambda: _files("examples/**/*.jcm", "tests/compatibility/*.jcm"), _ask_as_editor
    ),
    "edited-yaml": FileKind(".yaml", _mappings_and_worlds, _ask_as_editor),
    "mapping": FileKind(".yaml", lambda: _files("src/jacaros/robots/mappings/*.yaml"), _read_mapping),
    "world": FileKind(".yaml", lambda: _files("src/jacaros/robots/world/worlds/*.yaml"), _read_world),
    "parameters": FileKind(".yaml", lambda: _PARAMETERS, _read_parameters),
    "recording": FileKind(".jsonl", _recordings, _read_recording, _json_lines_changed),
    "ground-truth": FileKind(".jsonl", _ground_truths, _read_ground_truth, _json_lines_changed),
    "rosbridge": FileKind(".frame", _frames, _read_frame, _cbor_changed),
}
