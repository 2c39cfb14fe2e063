"""Recording a run and reading it back."""

import gzip
import json
import threading
from pathlib import Path
from random import Random

import msgspec
import pytest

from jacaros.look.page.recorder import Recorder
from jacaros.look.page.scene import EmbeddedScene, RobotView
from jacaros.look.page.watch import Watch
from jacaros.look.records import recording as reading
from jacaros.look.records.line_format import CompressedLines, Lines, unpacked
from jacaros.look.records.recording import Recording
from jacaros.look.records.records import EventLine, TextLine
from jacaros.robots.ros.open import open_backend
from jacaros.robots.world import SimNode, World
from jacaros.runtime.clock import VirtualClock, run
from jacaros.runtime.errors import JacarosError


def at(x: float, battery: float = 100.0) -> list[RobotView]:
    return [RobotView("turtlebot", x, 0.0, 0.0, battery)]


def record(path: Path | None) -> Recorder:
    recorder = Recorder(path, keep=True)
    recorder.world(World.load("house").description.drawing())
    for step in range(5):
        recorder.frame(step * 0.1, at(step * 0.02))
    recorder.text(0.25, "cleaner", "Größe «7»\nzweite Zeile")
    recorder.event(0.3, "goal", {"agent": "cleaner", "goal": "clean(kitchen)", "state": "pursued"})
    recorder.close()
    return recorder


def test_a_recording_reads_back_unchanged(tmp_path: Path) -> None:
    recorder = record(tmp_path / "run.jsonl")
    assert Recording.read(tmp_path / "run.jsonl") == recorder.recording
    assert recorder.recording.robots == ["turtlebot"]
    assert recorder.recording.duration == pytest.approx(0.4)


def texts_of(path: Path) -> list[str]:
    return [text for _, _, text in Recording.read(path).texts]


def test_a_recorder_keeps_the_run_in_memory_without_a_path_alone(tmp_path: Path) -> None:
    for path, frames in ((None, 1), (tmp_path / "run.jsonl", 0)):
        recorder = Recorder(path)
        recorder.frame(0.0, at(0.0))
        recorder.close()
        assert len(recorder.recording.frames) == frames
        assert path is None or recorder.recording == Recording()


@pytest.mark.parametrize(
    ("given", "kept"),
    [
        ([*((step * 0.1, 1.0) for step in range(100)), (10.0, 1.5)], [(0.0, 1.0), (9.9, 1.0), (10.0, 1.5)]),
        ([(0.0, 1.0), (50.0, 1.0)], [(0.0, 1.0), (50.0, 1.0)]),
        ([(0.0, 1.0), (4.0, 1.0), (5.0, 1.5), (6.0, 2.0)], [(0.0, 1.0), (4.0, 1.0), (5.0, 1.5), (6.0, 2.0)]),
    ],
    ids=["a rest costs two frames", "the last rest is kept when the run ends", "frames stay in order"],
)
def test_a_robot_rests_and_then_starts_sharply(given, kept: list[tuple[float, float]]) -> None:
    recorder = Recorder()
    for t, x in given:
        recorder.frame(t, at(x))
    recorder.close()
    recorder.close()
    assert [(frame.t, frame.robots[0].x) for frame in recorder.recording.frames] == kept
    assert recorder.recording.duration == given[-1][0]


def test_a_line_truncated_by_a_crash_or_a_full_disk_is_skipped(tmp_path: Path) -> None:
    path = tmp_path / "run.jsonl"
    record(path)
    lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
    path.write_text("".join(lines) + '{"kind": "fra', encoding="utf-8")
    assert len(Recording.read(path).frames) == 5
    path.write_text(lines[0] + lines[1][:20] + "\n" + "".join(lines[2:]), encoding="utf-8")
    assert len(Recording.read(path).frames) == 4


@pytest.mark.parametrize("name", ["run.jsonl", "run.jsonl.gz"])
def test_records_are_in_the_file_during_the_run(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    recorder = Recorder(path)
    recorder.world({"name": "nowhere"})
    recorder.text(0.1, "ann", "hello")
    while path.stat().st_size < 50 or not (path.suffix == ".gz" or path.read_text().endswith("\n")):
        threading.Event().wait(0.01)
    assert Recording.read(path).texts == [(0.1, "ann", "hello")]
    recorder.close()


@pytest.mark.parametrize(
    ("name", "limit", "count", "least"),
    [("run.jsonl", 20_000, 1000, 100), ("run.jsonl.gz", 40_000, 3000, 300)],
)
def test_a_long_recording_keeps_its_newest_half(tmp_path, name: str, limit, count: int, least: int) -> None:
    path, generator = tmp_path / name, Random(1)
    recorder = Recorder(path, limit=limit)
    recorder.world({"name": "nowhere"})
    for number in range(count):
        recorder.text(number / 10, "ann", f"line {number} {generator.random()}")
    recorder.close()
    assert path.stat().st_size + path.with_name(f"{name}.1").stat().st_size <= limit
    assert Recording.read(path).world == {"name": "nowhere"}
    numbers = [int(text.split()[1]) for text in texts_of(path)]
    assert len(numbers) > least
    assert numbers == list(range(count - len(numbers), count))


def test_an_older_part_of_another_run_is_not_read(tmp_path: Path) -> None:
    record(tmp_path / "run.jsonl.1")
    record(tmp_path / "run.jsonl")
    assert len(Recording.read(tmp_path / "run.jsonl").texts) == 1


def test_a_full_disk_logs_a_warning_and_does_not_stop_the_run() -> None:
    if not Path("/dev/full").exists():
        pytest.skip("this system has no /dev/full")
    warnings: list[str] = []
    recorder = Recorder("/dev/full", warn=warnings.append)
    recorder.world({"name": "nowhere"})
    recorder.close()
    assert warnings == [
        "cannot write to /dev/full: No space left on device; dropping lines until it works again",
        "1 line could not be written to /dev/full",
    ]


MALFORMED = [
    '{{"kind": "world", "world": {}}}\n{}\n{{}}\n'.format(*each)
    for each in (
        ("[]", "{}"),
        ('{"robots": [{}]}', "{}"),
        ("{}", '{"kind": "frame", "t": "x", "robots": []}'),
        ("{}", '{"kind": "frame", "t": NaN, "robots": []}'),
        ("{}", '{"kind": "frame", "t": 1, "robots": [[1]]}'),
        ("{}", '{"kind": "text", "t": 1, "agent": [], "text": ""}'),
        ("{}", '{"kind": "event", "t": 1, "event": "x", "data": 3}'),
        ("{}", "[" * 100_000),
    )
]


@pytest.mark.parametrize(
    "content", ["", '{"kind": "frame", "t": 0}\n{}\n', "hello\nworld\n", "[1]\n[2]\n", *MALFORMED]
)
def test_a_file_that_is_not_a_recording_is_rejected(tmp_path: Path, content: str) -> None:
    path = tmp_path / "other.jsonl"
    path.write_text(content)
    with pytest.raises(JacarosError, match=r"other\.jsonl"):
        Recording.read(path)


def watched_run() -> tuple[Recorder, World]:
    clock, world, recorder = VirtualClock(), World.load("house"), Recorder()

    async def main() -> None:
        backend = open_backend("memory", clock, "test")
        await backend.start()
        node = SimNode(world, backend, clock)
        node.start()
        watch = Watch(clock, [recorder], EmbeddedScene(lambda: world))
        watch.start()
        publisher = backend.publisher("/cmd_vel", "geometry_msgs/msg/Twist")
        for _ in range(20):
            publisher.publish(publisher.message(linear={"x": 0.3}))
            await clock.sleep(0.1)
        watch.text("cleaner", "here I am")
        await clock.sleep(2.0)
        watch.stop()
        node.close()
        await backend.close()

    run(main, clock)
    recorder.close()
    return recorder, world


def test_a_watch_records_frames_and_prints() -> None:
    recorder, world = watched_run()
    recording = recorder.recording
    assert recording.frames[0].t == 0.0
    assert recording.frames[-1].robots[0].x == pytest.approx(world.robot().x, abs=6e-4)
    assert recording.texts == [(pytest.approx(2.0), "cleaner", "here I am")]


def test_a_watched_run_is_the_same_as_an_unwatched_one() -> None:
    _, watched = watched_run()
    unwatched = World.load("house")
    for _ in range(20):
        unwatched.command("turtlebot", 0.3, 0.0)
        unwatched.run(0.1)
    unwatched.run(watched.time - unwatched.time)
    assert watched.ground_truth.digest() == unwatched.ground_truth.digest()


def test_a_compressed_recording_reads_back_the_same(tmp_path: Path) -> None:
    recorder = record(tmp_path / "run.jsonl.gz")
    assert (tmp_path / "run.jsonl.gz").read_bytes().startswith(b"\x1f\x8b")
    assert Recording.read(tmp_path / "run.jsonl.gz") == recorder.recording
    with gzip.open(tmp_path / "run.jsonl.gz", "rt", encoding="utf-8") as lines:
        assert len(lines.readlines()) == 8


def test_a_truncated_compressed_recording_is_read_to_its_end(tmp_path: Path) -> None:
    path, whole = tmp_path / "run.jsonl.gz", record(tmp_path / "whole.jsonl.gz").recording
    data = (tmp_path / "whole.jsonl.gz").read_bytes()
    counts = set()
    for length in range(len(data) - 20, len(data)):
        path.write_bytes(data[:length])
        recording = Recording.read(path)
        assert recording.world == whole.world
        counts.add(len(recording.frames))
    assert max(counts) == len(whole.frames)


def test_records_after_damage_in_a_compressed_recording_are_read(tmp_path: Path) -> None:
    """A full disk has not taken a piece: the members behind it can be read."""
    form = CompressedLines()
    pieces = [form.pack([{"kind": "world", "version": 2, "world": {"name": "nowhere"}}])]
    for number in range(12):
        text = "x" * 300_000 + str(number)
        pieces.append(form.pack([{"kind": "text", "t": number, "agent": "ann", "text": text}]))
    path = tmp_path / "run.jsonl.gz"
    path.write_bytes(b"".join([*pieces[:2], *pieces[3:]]))
    numbers = [int(text.lstrip("x")) for text in texts_of(path)]
    assert numbers[0] == 0
    assert numbers[-1] == 11
    assert 1 not in numbers
    assert len(numbers) >= 8


def test_known_records_of_a_newer_version_are_read_with_a_warning(tmp_path: Path) -> None:
    path = tmp_path / "run.jsonl"
    path.write_text(
        '{"kind": "world", "version": 9, "world": {"name": "nowhere", "new": 1}}\n'
        '{"kind": "frame", "t": 1, "robots": [[1, 2, 3, 4, 5, 6, 7]]}\n'
        '{"kind": "frame", "t": 2, "robots": "other"}\n'
        '{"kind": "hologram", "t": 3}\n'
        '{"kind": "text", "t": 4, "agent": "ann", "text": "hello", "colour": "red"}\n',
        encoding="utf-8",
    )
    recording = Recording.read(path)
    assert [frame.robots for frame in recording.frames] == [((1, 2, 3, 4, 5, 6),)]
    assert recording.texts == [(4, "ann", "hello")]
    [warning] = recording.warnings
    assert "version 9" in warning


def test_a_truncated_recording_is_read_with_a_warning(tmp_path: Path) -> None:
    path = tmp_path / "run.jsonl"
    record(path)
    assert Recording.read(path).warnings == []
    path.write_bytes(path.read_bytes()[:-10])
    recording = Recording.read(path)
    assert len(recording.frames) == 5
    assert recording.warnings == [f"{path} is cut off or damaged: what can be read of it is shown"]


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("[1, 2]", "Expected `object`, got `array`"),
        ("{}", "Object missing required field `kind`"),
        (
            '{"kind": "world", "world": {"robots": [{}]}}',
            "Object missing required field `name` - at `$.robots[0]`",
        ),
    ],
)
def test_an_invalid_line_is_reported_with_its_location_and_help(tmp_path, line: str, reason: str) -> None:
    path = tmp_path / "run.jsonl"
    path.write_text(f"{line}\n\n", encoding="utf-8")
    with pytest.raises(JacarosError) as refused:
        Recording.read(path)
    help_ = "\n  = help: `jacaros run FILE --record RUN.jsonl` makes one"
    assert str(refused.value) == f"error: not a recording: {reason}\n  --> {path}:1{help_}"


def test_a_text_that_looks_like_a_record_stays_in_its_record() -> None:
    records = [
        EventLine(1.0, "x", {"data": [{"kind": "a"}, {"kind": "b"}]}),
        TextLine(1.0, "ann", '}, {"kind": "x'),
        TextLine(1.0, "ann", "\ud800 and ü"),
    ]
    lines = Lines().pack(records).decode("utf-8").splitlines()
    assert [json.loads(line) for line in lines] == msgspec.to_builtins(records)


@pytest.mark.parametrize(("older", "read"), [(1, False), (2, True), (3, False)])
def test_only_the_part_before_is_read_with_a_later_part(tmp_path: Path, older: int, read: bool) -> None:
    for name, part in (("run.jsonl", 3), ("run.jsonl.1", older)):
        (tmp_path / name).write_text(
            f'{{"kind": "world", "version": 2, "world": {{}}, "part": {part}}}\n'
            f'{{"kind": "text", "t": 1, "agent": "ann", "text": "{name}"}}\n',
            encoding="utf-8",
        )
    assert texts_of(tmp_path / "run.jsonl") == (["run.jsonl.1", "run.jsonl"] if read else ["run.jsonl"])


def test_damage_in_front_of_whole_members_is_reported(tmp_path: Path) -> None:
    form = CompressedLines()
    members = []
    for number in range(3):
        text = {"kind": "text", "t": number, "agent": "a", "text": "x"}
        members.append(bytearray(form.pack([{"kind": "world", "world": {}}, text]) + form.end()))
    members[0][15:] = b"\xff" * (len(members[0]) - 15)
    damages: list[bool] = []
    content = b"".join(unpacked(b"".join(members), 2**20, lambda: damages.append(True)))
    assert damages == [True]
    assert content.count(b'"text": "x"') == 2


def test_a_compressed_recording_that_contains_too_much_is_an_error(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr(reading, "LARGEST", 100_000)
    record(tmp_path / "run.jsonl")
    line = b'{"kind": "text", "t": 1, "agent": "ann", "text": "' + b"a" * 1000 + b'"}\n'
    whole = (tmp_path / "run.jsonl").read_bytes()
    packed = tmp_path / "run.jsonl.gz"
    packed.write_bytes(gzip.compress(whole + line * 50))
    assert len(Recording.read(packed).texts) == 51
    packed.write_bytes(gzip.compress(whole + line * 2000))
    with pytest.raises(JacarosError, match=r"compressed content is larger than .*\n.*gzip -dc"):
        Recording.read(packed)
    (tmp_path / "run.jsonl").write_bytes(whole + line * 2000)  # unpacked by the user
    assert len(Recording.read(tmp_path / "run.jsonl").texts) == 2001


def test_a_large_compressed_recording_of_a_run_is_read(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr(reading, "LARGEST", 1000)
    path, generator = tmp_path / "run.jsonl.gz", Random(1)
    recorder = Recorder(path)
    recorder.world({"name": "nowhere"})
    for number in range(3000):
        recorder.frame(number / 10, at(generator.random() * 5, generator.random() * 100))
        recorder.event(number / 10, "belief", {"agent": "ann", "op": "+", "belief": f"seen({number})"})
    recorder.close()
    assert len(Recording.read(path).frames) == 3000
