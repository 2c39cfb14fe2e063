"""Options of a run in a fleet: the part of the project that runs, and the options that the system gets."""

from pathlib import Path
from typing import Any

import pytest
from command_lab import Outcome

from jacaros.fleet.network import Network
from jacaros.runtime.cli import run
from jacaros.runtime.cli.fleet_options import join_of
from jacaros.runtime.cli.nodes import arguments_of_nodes
from jacaros.runtime.cli.outputs import RequestedOutputs
from jacaros.runtime.mas.deployment import Deployment
from jacaros.runtime.mas.options import RunOptions

COMMAND = ("run",)
HOUSE = """
mas house {
  agent ann : a.asl { node: base }
  agent bob : a.asl { node: robot }
  node base
  node robot
}
"""
TOGETHER = (
    "note: the nodes `base`, `robot` run in one process; --all-nodes runs each in its own, and --node base runs one of "
    "them\n"
)


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "house.jcm").write_text(HOUSE)
    (tmp_path / "router.jcm").write_text("mas m { agent ann : a.asl  node router }")
    (tmp_path / "plain.jcm").write_text("mas plain { agent ann : a.asl }")
    (tmp_path / "a.asl").write_text("!go. +!go <- .my_name(Me); .print(Me).")
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("JACAROS_CLOCK", raising=False)


@pytest.fixture
def launched(monkeypatch: pytest.MonkeyPatch) -> list[tuple[Deployment, RunOptions]]:
    """What would have been launched."""
    found: list[tuple[Deployment, RunOptions]] = []

    def launch(project: Deployment, options: RunOptions, *_: Any, **__: Any) -> int:
        found.append((project, options))
        return 0

    monkeypatch.setattr(run, "launch", launch)
    monkeypatch.setattr(run, "join_of", lambda *_: None)
    return found


def test_without_a_node_all_of_them_run_in_one_process(outcome: Outcome) -> None:
    assert outcome("house.jcm", "--until-idle") == (0, "[ann] ann\n[bob] bob\n", TOGETHER)
    assert outcome("plain.jcm", "--until-idle") == (0, "[ann] ann\n", "")


@pytest.mark.parametrize(
    ("arguments", "fleet", "member", "agents"),
    [
        (("house.jcm", "--node", "robot"), "house", "robot", ["bob"]),
        (("house.jcm", "--node", "base", "--fleet", "lab"), "lab", "base", ["ann"]),
        (("house.jcm", "--fleet", "lab"), "lab", "house", ["ann", "bob"]),
        (("a.asl", "--fleet", "lab"), "lab", "a", ["a"]),
        (("a.asl", "--fleet", "lab", "--member", "one"), "lab", "one", ["a"]),
        (("a.asl",), None, None, ["a"]),
    ],
)
def test_a_system_is_a_member_of_a_fleet(
    outcome: Outcome,
    launched: list[tuple[Deployment, RunOptions]],
    arguments: tuple[str, ...],
    fleet: str | None,
    member: str | None,
    agents: list[str],
) -> None:
    assert outcome(*arguments)[0] == 0
    ((project, options),) = launched
    assert (options.fleet, options.member) == (fleet, member)
    assert [agent.name for agent in project.agents] == agents


def test_processes_of_nodes_have_different_names_in_a_graph(
    outcome: Outcome, launched: list[tuple[Deployment, RunOptions]]
) -> None:
    for node in ("base", "robot"):
        outcome("house.jcm", "--node", node)
    assert [project.name for project, _ in launched] == ["house_base", "house_robot"]


def test_keys_and_routers_are_passed_on(
    outcome: Outcome, launched: list[tuple[Deployment, RunOptions]]
) -> None:
    outcome("a.asl", "--fleet", "lab", "--fleet-keys", "keys", "--router", "tls/a:1", "--router", "tls/b:2")
    options = launched[0][1]
    assert (options.fleet_keys, options.fleet_routers) == (Path("keys"), ("tls/a:1", "tls/b:2"))


@pytest.mark.parametrize(
    ("arguments", "message", "help"),
    [
        (("house.jcm", "--node", "robt"), "unknown node `robt`", "did you mean `robot`?"),
        (("house.jcm", "--node", "x"), "unknown node `x`", "nodes of `house.jcm`: base, robot"),
        (("plain.jcm", "--node", "x"), "`plain.jcm` declares no nodes", "`node lab`"),
        (("router.jcm", "--all-nodes"), "`router` cannot be the name of a member", "router1"),
        (("a.asl", "--all-nodes"), "`a.asl` declares no nodes", "`node lab`"),
        (("house.jcm", "--node", "base", "--all-nodes"), "--node excludes --all-nodes", "--node base"),
        (("house.jcm", "--node", "base", "--member", "x"), "--member excludes --node", "of its name"),
        (("a.asl", "--member", "x"), "--member needs --fleet NAME", ""),
        (("a.asl", "--fleet-keys", "keys"), "--fleet-keys needs --fleet NAME", ""),
        (("a.asl", "--router", "tls/a:1"), "--router needs --fleet NAME", ""),
        (("a.asl", "--fleet", "lab", "--clock", "fast"), "--clock fast excludes the fleet `lab`", ""),
        (("house.jcm", "--all-nodes", "--clock", "fast"), "--clock fast excludes the fleet `house`", ""),
        (("house.jcm", "--all-nodes", "--view=terminal"), "--view=terminal excludes --all-nodes", "--view"),
        (("house.jcm", "--all-nodes", "--view-port", "8080"), "--view-port 8080 excludes", "--view"),
    ],
)
def test_wrong_options_of_a_fleet_are_refused(
    outcome: Outcome, arguments: tuple[str, ...], message: str, help: str
) -> None:
    code, output, errors = outcome(*arguments)
    assert (code, output) == (2, "")
    assert f"error: {message}" in errors
    assert help in errors.partition("= help: ")[2]


@pytest.mark.parametrize("arguments", [("a.asl", "--fleet", "lab"), ("house.jcm", "--all-nodes")])
def test_a_fleet_without_its_library_is_one_error(
    outcome: Outcome, monkeypatch: pytest.MonkeyPatch, arguments: tuple[str, ...]
) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    assert outcome(*arguments) == (
        2,
        "",
        'error: a fleet needs eclipse-zenoh, which is not installed\n  = help: pip install "jacaros[fleet]"\n',
    )


def test_each_node_has_output_files_and_keys_of_its_own() -> None:
    outputs = RequestedOutputs(record=Path("runs/r.jsonl.gz"), replay=Path("r.html"))
    given = ["house.jcm", "--all-nodes", "--record", "runs/r.jsonl.gz", "--seed", "1"]
    common = ["house.jcm", "--record", "runs/r.jsonl.gz", "--seed", "1"]
    assert arguments_of_nodes(given, outputs, Path("keys"))("base") == [
        *common,
        *("--node", "base"),
        *("--record", str(Path("runs/base.r.jsonl.gz"))),
        *("--replay", "base.r.html"),
        *("--fleet-keys", str(Path("keys/base"))),
    ]


def test_the_lease_reaches_the_network(monkeypatch: pytest.MonkeyPatch) -> None:
    networks: list[Network] = []
    monkeypatch.setattr(
        "jacaros.fleet.on_zenoh.ZenohCarrier", lambda network, *more: networks.append(network)
    )
    assert join_of(RunOptions(fleet="lab", member="robot", fleet_lease=6.0), lambda text: None) is not None
    assert [each.lease for each in networks] == [6.0]
