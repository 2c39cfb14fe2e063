"""Offers in mapping files: what is read, what is wrong, and how a run uses them."""

from pathlib import Path

import pytest

import jacaros
from jacaros import Mas
from jacaros.robots.mapping.file import MappingError, read_mapping
from jacaros.robots.ros.action import GoalStatus
from jacaros.runtime.cli.main import call
from jacaros.runtime.mas.mappings import check_mapping_file, files_with_offers
from jacaros.serving.ros.opening import open_door

GO = """
offers:
  go:
    type: nav2_msgs/action/NavigateToPose
    goal: {x: pose.pose.position.x, y: pose.pose.position.y}
"""


def wrong_in(text: str, tmp_path: Path) -> list[str]:
    """The mistakes of a mapping file."""
    file = tmp_path / "robot.yaml"
    file.write_text(text)
    return [each.message for each in check_mapping_file(file, lambda _: None)]


def test_offers_need_no_artifacts() -> None:
    found = read_mapping(GO)
    assert (list(found.offers), found.artifacts, found.roles) == (["go"], {}, ())


def test_offers_stand_beside_an_artifact_or_several() -> None:
    beside = read_mapping(
        GO + "properties: {odom: {topic: odom, type: nav_msgs/msg/Odometry}}\nroles: [nurse]"
    )
    assert (list(beside.offers), list(beside.artifacts), beside.roles) == (["go"], ["mapping"], ("nurse",))
    several = read_mapping(
        GO + "artifacts: {base: {operations: {look: {service: a, type: std_srvs/srv/Empty}}}}"
    )
    assert (list(several.offers), list(several.artifacts)) == (["go"], ["base"])


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("pose.pose.position.x", "pose.pose.place.x", "place"),
        ("nav2_msgs/action/NavigateToPose", "nav2_msgs/action/Fly", "is not known here"),
        ("nav2_msgs/action/NavigateToPose", "nav2_msgs/srv/Fly", "type of a service"),
        ("    goal:", "    gaol:", "has no key 'gaol'"),
        ("    type:", "    kind:", "lacks the key 'type'"),
        (
            "    goal:",
            "    feedback: {distance_remaining: $distance}\n    goal:",
            "feedback has no `$distance`",
        ),
    ],
)
def test_mistakes_are_reported_at_their_place(old: str, new: str, message: str, tmp_path: Path) -> None:
    assert wrong_in(GO, tmp_path) == []
    wrong = wrong_in(GO.replace(old, new), tmp_path)
    assert message in "\n".join(wrong)
    assert wrong


def test_a_run_finds_the_files_with_offers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("go.yaml").write_text(GO)
    Path("odom.yaml").write_text("properties: {odom: {topic: odom, type: nav_msgs/msg/Odometry}}")

    async def main() -> None:
        async with Mas(world="none", mappings=("go.yaml", "odom.yaml"), on_log=lambda *_: None) as mas:
            assert files_with_offers(mas.system.deployment, mas.system.options.mappings) == [Path("go.yaml")]

    jacaros.run(main(), clock="fast")


@pytest.mark.parametrize(
    ("offer", "warning"),
    [
        ("go(x(number), y(number))", ""),
        ("go(x(number))", "`goal` names `y`, which go(x: number) does not have"),
        ("go(x(number), y(number), z(number))", "`goal` lacks `z`"),
        ("come", "no agent offers `go`, which a mapping file describes"),
    ],
)
def test_a_mapping_must_fit_the_offer(offer: str, warning: str, tmp_path: Path) -> None:
    file = tmp_path / "go.yaml"
    file.write_text(GO)
    log: list[str] = []

    async def main() -> None:
        async with Mas(world="none", mappings=(str(file),), on_log=lambda text, _: log.append(text)) as mas:
            mas.add_agent("bob", f"{{ offer(goal, {offer}) }} +!go(_, _).")
            open_door(mas.system)

    jacaros.run(main(), clock="fast")
    warnings = [each for each in log if "[ros] warning" in each]
    assert len(warnings) == bool(warning)
    assert warning in "".join(warnings)


def test_feedback_and_results_that_do_not_fit_their_type_are_reported(tmp_path: Path) -> None:
    file = tmp_path / "go.yaml"
    wrong = "    feedback: {number_of_recoveries: $doing}\n    result: {error_code: $where}\n"
    file.write_text(GO + wrong)
    log: list[str] = []

    async def main() -> None:
        async with Mas(world="none", mappings=(str(file),), on_log=lambda text, _: log.append(text)) as mas:
            program = (
                "{ offer(goal, go(x(number), y(number), where(out(atom)))) } +!go(_, _, lab) <- .wait(1000)."
            )
            mas.add_agent("bob", program)
            open_door(mas.system)
            client = mas.system.ros.companion("client").action_client(
                "bob/go", "nav2_msgs/action/NavigateToPose"
            )
            outcome = await (await client.send({}, timeout=5)).outcome()
            assert outcome.status is GoalStatus.ABORTED
            assert "field error_code is uint16" in outcome.text

    jacaros.run(main(), clock="fast")
    assert sum("does not fit nav2_msgs/action/NavigateToPose" in each for each in log) == 1


def test_a_file_with_errors_stops_the_run(tmp_path: Path) -> None:
    file = tmp_path / "go.yaml"
    file.write_text(GO.replace("position.x", "place"))

    async def main() -> None:
        async with Mas(world="none", mappings=(str(file),), on_log=lambda *_: None) as mas:
            with pytest.raises(MappingError, match="place"):
                open_door(mas.system)

    jacaros.run(main(), clock="fast")


PROGRAM = "{ offer(goal, go(x(number), y(number))) } +!go(_, _)."


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--offer"], "note: bob offers go below /bob"),
        (["--mapping", "go.yaml"], "note: bob offers go below /bob"),
        (["--offer", "--namespace", "left"], "below /left/bob"),
        ([], ""),
    ],
)
def test_the_command_line_opens_the_door(
    options: list[str],
    told: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("bob.asl").write_text(PROGRAM)
    Path("go.yaml").write_text(GO)
    assert call(["run", "bob.asl", "--until-idle", "--clock", "fast", *options]) == 0
    errors = capsys.readouterr().err
    assert told in errors if told else errors == ""


def test_a_lifecycle_needs_ros_2(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "bob.asl"
    file.write_text(PROGRAM)
    assert call(["run", str(file), "--ros", "ros1", "--lifecycle"]) == 2
    assert "--lifecycle needs a ROS 2 graph" in capsys.readouterr().err
