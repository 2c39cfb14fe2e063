"""Nodes of projects: what is declared, what is wrong, and what runs at one of them."""

from collections.abc import Callable
from pathlib import Path

import pytest

from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.runtime.mas.deployment import Deployment, FocusSpec
from jacaros.runtime.mas.project.nodes import at_node

Load = Callable[[str], Deployment]
Diagnostics = Callable[[str], list[Diagnostic]]

HOUSE = """
    mas house {
      agent bob { node: robot  join: hall  focus: lab.clock@base, bell@robot, main.door }
      agent ann : bob.asl { instances: 2  node: base }
      agent carl : bob.asl
      workspace main { artifact door : Door }
      workspace lab { artifact clock : Clock { focused-by: carl }  agents: ann1  node: base }
      workspace shelf { parent: lab  artifact book : Book }
      workspace hall { host: robot  artifact bell : Bell }
      node base running at "10.1.1.1:7447"
      node robot @ robot.lab
    }
    """


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name in ("bob", "alice"):
        (tmp_path / f"{name}.asl").write_text("", encoding="utf-8")
    return tmp_path


@pytest.fixture
def house(load: Load) -> Deployment:
    return load(HOUSE)


def test_a_project_declares_nodes_with_their_addresses(house: Deployment) -> None:
    assert [(node.name, node.address) for node in house.nodes] == [
        ("base", "10.1.1.1:7447"),
        ("robot", "robot.lab"),
    ]
    assert {agent.name: agent.node for agent in house.agents} == {
        "bob": "robot",
        "ann1": "base",
        "ann2": "base",
        "carl": None,
    }
    assert {each.name: each.node for each in house.workspaces} == {
        "main": None,
        "lab": "base",
        "shelf": "base",
        "hall": "robot",
    }
    assert house.ignored == ()


def test_without_a_node_everything_is_joined_at_the_start(house: Deployment) -> None:
    assert house.agents[0].join == ("hall", "lab", "main")
    assert {agent.join_later for agent in house.agents} == {()}


def test_what_names_no_node_runs_at_the_first_one(house: Deployment) -> None:
    base = at_node(house, "base")
    assert [agent.name for agent in base.agents] == ["ann1", "ann2", "carl"]
    assert [each.name for each in base.workspaces] == ["main", "lab", "shelf"]
    assert {agent.join_later for agent in base.agents} == {()}
    assert base.agents[2].focus == (FocusSpec("clock", "lab"),)


def test_workspaces_of_other_nodes_are_joined_later(house: Deployment) -> None:
    robot = at_node(house, "robot")
    assert [each.name for each in robot.workspaces] == ["hall"]
    (bob,) = robot.agents
    assert bob.join == ("hall", "/main/lab", "/main@base")
    assert bob.join_later == ("/main/lab", "/main@base")
    assert bob.focus == (
        FocusSpec("clock", "/main/lab"),
        FocusSpec("bell", "hall"),
        FocusSpec("door", "/main@base"),
    )


def test_a_workspace_of_a_node_need_not_be_declared(load: Load) -> None:
    deployment = load("""
        mas m {
          agent bob { join: attic@there  focus: w.a@there, ns::w.b@here }
          agent ann : bob.asl { node: there }
          node here
          node there
        }
        """)
    for each in (deployment, at_node(deployment, "here")):
        assert each.agents[0].join == each.agents[0].join_later == ("/main/attic", "/main/w")
        assert each.agents[0].focus == (FocusSpec("a", "/main/w"), FocusSpec("b", "/main/w", "ns"))


def test_a_workspace_that_only_its_children_declare_is_at_their_node(load: Load) -> None:
    deployment = load("""
        mas m {
          agent bob { join: floor/room }
          workspace floor/room { node: there }
          node here
          node there
        }
        """)
    assert [each.name for each in at_node(deployment, "there").workspaces] == ["floor", "room"]
    assert at_node(deployment, "here").workspaces == ()
    assert at_node(deployment, "here").agents[0].join_later == ("/main/floor/room",)


def test_nodes_of_used_projects_come_first(load: Load, write: Callable[..., object]) -> None:
    write("mas base { agent bob { node: one }  node one }", "base.jcm")
    deployment = load("mas m uses base { agent alice { node: two }  node two }")
    assert [node.name for node in deployment.nodes] == ["one", "two"]


WRONG = [
    ("agent bob { node: robt }", "2:19", "unknown node `robt`", "did you mean `robot`?"),
    ("agent bob { node: attic }", "2:19", "unknown node `attic`", "declare it in the project: `node attic`"),
    ("workspace w { host: robt }", "2:21", "unknown node `robt`", "did you mean `robot`?"),
    ("agent bob { join: hall@robt }", "2:24", "unknown node `robt`", "did you mean `robot`?"),
    ("agent bob { focus: bell@robt }", "2:25", "unknown node `robt`", "did you mean `robot`?"),
    (
        "agent bob { join: hall@base }",
        "2:19",
        "workspace `hall` is not at node `base`",
        "write `hall@robot`, or `node: base` in the workspace",
    ),
    (
        "agent bob { focus: bel@robot }",
        "2:20",
        "unknown artifact `bel` at node `robot`",
        "did you mean `bell`?",
    ),
    (
        "agent bob { focus: bell@base }",
        "2:20",
        "unknown artifact `bell` at node `base`",
        "if an agent creates it, name its workspace, too: `workspace.bell`",
    ),
    (
        "workspace w { parent: hall  node: base }",
        "2:35",
        "the workspace around `w` is at another node: `robot`",
        "write `node: robot`, or declare `w` outside of it",
    ),
    ("node base", "4:6", "duplicate node `base`", "the first one is at p.jcm:2"),
    (
        "node a/b",
        "2:6",
        "invalid name of a node: `a/b`",
        "use up to 48 letters, digits, `_` and `-`, beginning with a letter or digit",
    ),
    (
        "node n @ 10.1.1.1:port",
        "2:10",
        "invalid address `10.1.1.1:port`",
        "write `host` or `host:port`",
    ),
]


@pytest.mark.parametrize(("section", "place", "message", "help"), WRONG)
def test_mistakes_about_nodes_are_errors(
    folder: Path, diagnostics: Diagnostics, section: str, place: str, message: str, help: str
) -> None:
    found = diagnostics(f"""\
        mas m {{
        {section}
        agent alice : bob.asl {{ node: base }}
        node base
        workspace hall {{ node: robot  artifact bell : Bell }}
        node robot
        }}
        """)
    errors = [each for each in found if each.severity == "error"]
    assert [(each.message, (each.help or "").replace(f"{folder.as_posix()}/", "")) for each in errors] == [
        (message, help)
    ]
    assert errors[0].span is not None
    assert f"{errors[0].span.line}:{errors[0].span.column}" == place


def test_a_node_at_which_nothing_runs_is_a_warning(diagnostics: Diagnostics) -> None:
    found = diagnostics("mas m {\n agent bob { node: one }\n node zero\n node one\n node two\n}")
    assert [(each.severity, each.message, each.help) for each in found] == [
        (
            "warning",
            f"nothing runs at node `{name}`",
            f"declare an agent or a workspace with `node: {name}`",
        )
        for name in ("zero", "two")
    ]
