"""The keys of a fleet: created once, checked before they are used, with an error for each thing that does not fit."""

import shutil
import stat
import subprocess
import sys
from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
from players import Player
from ports import free_port

from jacaros.fleet import authority, keys
from jacaros.fleet.authority import create_keys, members_in
from jacaros.fleet.keys import find_keys, read_keys
from jacaros.fleet.network import Network, session_config
from jacaros.runtime.errors import UsageError

FILES = {"ca.pem", "cert.pem", "key.pem", "members.txt"}


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    """The keys of fleet `lab`, with two members."""
    create_keys(tmp_path / "lab", "lab", ["one", "two"])
    return tmp_path / "lab"


def contents(folder: Path) -> dict[Path, bytes]:
    """All files of a folder."""
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_each_member_gets_a_folder_that_only_its_user_can_read(lab: Path) -> None:
    assert {each.name for each in lab.iterdir()} == {"authority", "router", "operator", "one", "two"}
    for name in ("router", "operator", "one", "two"):
        assert {each.name for each in (lab / name).iterdir()} == FILES
        assert stat.S_IMODE((lab / name).stat().st_mode) == 0o700
        assert stat.S_IMODE((lab / name / "key.pem").stat().st_mode) == 0o600
    assert stat.S_IMODE((lab / "authority" / "key.pem").stat().st_mode) == 0o600
    assert read_keys(lab / "one", "lab", "one").members == ("one", "operator", "two")


def test_running_again_adds_members_and_keeps_all_keys(lab: Path) -> None:
    before = contents(lab)
    assert create_keys(lab, "lab", ["one", "three"]) == ["three"]
    after = contents(lab)
    assert {path for path, content in before.items() if after[path] != content} == {
        lab / name / "members.txt" for name in ("one", "two", "router", "operator")
    }
    for name in ("one", "two", "three", "router"):
        assert read_keys(lab / name, "lab", name).members == ("one", "operator", "three", "two")


def test_a_member_whose_folder_is_deleted_is_no_longer_in_the_lists(lab: Path) -> None:
    shutil.rmtree(lab / "two")
    create_keys(lab, "lab", [])
    assert members_in(lab) == ["one", "operator"]
    assert (lab / "router" / "members.txt").read_text() == "one\noperator\n"


def test_an_interrupted_command_leaves_no_half_of_a_folder(
    lab: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*_: object) -> bytes:
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr(authority, "_private_pem", broken)
        with pytest.raises(KeyboardInterrupt):
            create_keys(lab, "lab", ["three"])
    assert create_keys(lab, "lab", ["three"]) == ["three"]
    read_keys(lab / "three", "lab", "three")


def test_copied_keys_do_not_become_a_second_authority(lab: Path) -> None:
    shutil.rmtree(lab / "authority")
    with pytest.raises(
        UsageError, match="has keys, but no authority\n  = help: add members on the computer on which"
    ):
        create_keys(lab, "lab", ["three"])


@pytest.mark.parametrize("name", ["router", "authority", "a/b", "", ".hidden", "a@b"])
def test_names_of_members_are_checked(tmp_path: Path, name: str) -> None:
    with pytest.raises(UsageError, match=r"error: .*name of a member.*\n  = help: "):
        create_keys(tmp_path / "lab", "lab", ["one", name])
    assert not (tmp_path / "lab").exists()


def test_members_find_their_keys_in_the_configuration_of_the_user(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    assert find_keys("lab", "one") is None
    folder = tmp_path / "jacaros" / "fleets" / "lab" / "one"
    folder.mkdir(parents=True)
    assert find_keys("lab", "one") == folder


def remove(folder: Path) -> None:
    (folder / "cert.pem").unlink()


def expose(folder: Path) -> None:
    (folder / "key.pem").chmod(0o644)


def exchange_key(folder: Path) -> None:
    (folder / "key.pem").write_bytes((folder.parent / "two" / "key.pem").read_bytes())


def exchange_all(folder: Path) -> None:
    for name in FILES:
        (folder / name).write_bytes((folder.parent / "two" / name).read_bytes())


def exchange_authority(folder: Path) -> None:
    create_keys(folder.parent.parent / "other", "lab", ["one"])
    (folder / "ca.pem").write_bytes((folder.parent.parent / "other" / "one" / "ca.pem").read_bytes())


def of_another_fleet(folder: Path) -> None:
    create_keys(folder.parent.parent / "hall", "hall", ["one"])
    for name in FILES:
        (folder / name).write_bytes((folder.parent.parent / "hall" / "one" / name).read_bytes())


def spoil(name: str) -> Callable[[Path], None]:
    return lambda folder: (folder / name).write_text("nonsense") and None


def leave_out(folder: Path) -> None:
    (folder / "members.txt").write_text("two\n")


@pytest.mark.parametrize(
    ("change", "file", "what", "help"),
    [
        (remove, "cert.pem", "file does not exist", "copy the whole folder"),
        (expose, "key.pem", "other users can read this private key", "chmod 600 "),
        (exchange_key, "key.pem", "not the key of cert.pem", "create it again: `jacaros fleet keys lab one`"),
        (exchange_authority, "cert.pem", "not issued by the authority of ca.pem", "create it again"),
        (
            exchange_all,
            "cert.pem",
            "expected a certificate for the member `one`, found one for `two`",
            "name the folder",
        ),
        (
            of_another_fleet,
            "cert.pem",
            "expected a certificate for the fleet `lab`, found one for `hall`",
            "name the",
        ),
        (spoil("ca.pem"), "ca.pem", "not a certificate in PEM format", "create it again"),
        (spoil("cert.pem"), "cert.pem", "not a certificate in PEM format", "create it again"),
        (spoil("key.pem"), "key.pem", "not a private key in PEM format", "create it again"),
        (leave_out, "members.txt", "the member `one` is missing", "add a line `one`"),
    ],
)
def test_keys_that_do_not_fit_are_named(
    lab: Path, change: Callable[[Path], None], file: str, what: str, help: str
) -> None:
    change(lab / "one")
    with pytest.raises(UsageError) as raised:
        session_config(Network("lab", "one", lab / "one"))
    first, second = str(raised.value).split("\n")
    assert first == f"error: {lab / 'one' / file}: {what}"
    assert second.startswith(f"  = help: {help}")


@pytest.mark.parametrize(
    ("days", "what"),
    [(-2, r"valid from \d{4}-\d\d-\d\d, and the clock of this computer says .*\n  = help: set the clock"),
     (3651, r"expired on \d{4}-\d\d-\d\d\n  = help: delete the folder and create it again")],
)  # fmt: skip
def test_keys_outside_of_their_time_are_named(
    lab: Path, monkeypatch: pytest.MonkeyPatch, days: int, what: str
) -> None:
    class Clock:
        @staticmethod
        def now(zone: object) -> datetime:
            return datetime.now(UTC) + timedelta(days=days)

    monkeypatch.setattr(keys, "datetime", Clock)
    with pytest.raises(UsageError, match=f"^error: {lab}/one/cert.pem: {what}"):
        read_keys(lab / "one", "lab", "one")


def jacaros(*words: str, config: Path) -> subprocess.CompletedProcess[str]:
    """Run a command to its end."""
    environment = {"XDG_CONFIG_HOME": str(config), "PYTHONPATH": ":".join(sys.path), "PATH": "/usr/bin:/bin"}
    command = [sys.executable, "-m", "jacaros", *words]
    return subprocess.run(command, env=environment, capture_output=True, text=True, timeout=60, check=False)


def test_the_command_names_what_it_creates_and_what_to_copy(tmp_path: Path) -> None:
    fleet = tmp_path / "jacaros" / "fleets" / "lab"
    first = jacaros("fleet", "keys", "lab", "one", config=tmp_path)
    assert first.stdout.splitlines() == [
        f"created {fleet / 'authority'}",
        f"created {fleet / 'router'}",
        f"created {fleet / 'operator'}",
        f"created {fleet / 'one'}",
        "members of fleet lab: one, operator",
    ]
    second = jacaros("fleet", "keys", "lab", "two", config=tmp_path)
    assert second.stdout.splitlines() == [
        f"created {fleet / 'two'}",
        "members of fleet lab: one, operator, two",
        "copy members.txt of one, operator and router to their computers again, and restart them",
    ]
    assert first.returncode == second.returncode == 0
    wrong = jacaros("fleet", "keys", "lab", "router", config=tmp_path)
    assert wrong.returncode == 2
    assert wrong.stderr.startswith("error: `router` cannot be the name of a member")


def test_the_router_names_its_address_and_ends_on_ctrl_c(tmp_path: Path) -> None:
    port = free_port()
    with Player(
        command=["fleet", "router", "lab", "--listen", f"localhost:{port}", "--keys", str(tmp_path)]
    ) as wrong:
        assert wrong.process.wait(20) == 2
    with Player(command=["fleet", "router", "lab", "--listen", f"127.0.0.1:{port}"]) as router:
        router.until(rf"router of fleet lab: members connect to 127\.0\.0\.1:{port}; press Ctrl\+C to stop")
        with Player(command=["fleet", "router", "lab", "--listen", f"127.0.0.1:{port}"]) as second:
            second.until(f"error: cannot listen on 127.0.0.1:{port}: address already in use")
        router.interrupt()
        assert router.process.wait(10) == 130


def test_a_router_without_keys_stays_on_its_computer(tmp_path: Path) -> None:
    wrong = jacaros("fleet", "router", "lab", "--listen", "0.0.0.0", config=tmp_path)
    assert wrong.returncode == 2
    assert wrong.stderr.startswith(
        "error: 0.0.0.0: a fleet without keys stays on its computer\n  = help: create keys"
    )
