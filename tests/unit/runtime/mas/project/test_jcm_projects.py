"""Features of real `.jcm` and `.mas2j` projects, in files of our own."""

from collections.abc import Callable
from pathlib import Path

import pytest

from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.artifacts.env.values import Atom
from jacaros.runtime.mas.checks.files import check_files
from jacaros.runtime.mas.deployment import Deployment, FocusSpec, ProjectError
from jacaros.runtime.mas.launch import load_deployment
from jacaros.runtime.mas.project.reading import read_project


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "src" / "agt" / "inc").mkdir(parents=True)
    for name in ("bob", "alice", "carl"):
        (tmp_path / "src" / "agt" / f"{name}.asl").write_text("+!start.\n", encoding="utf-8")
    return tmp_path


Load = Callable[[str], Deployment]
Write = Callable[..., Path]
Diagnostics = Callable[[str], list[Diagnostic]]
Errors = Callable[[str], list[tuple[int, str]]]


@pytest.fixture
def errors(diagnostics: Diagnostics) -> Errors:
    return lambda text: [
        (d.span.line if d.span else 0, d.message) for d in diagnostics(text) if d.severity == "error"
    ]


def by_name(deployment: Deployment) -> dict[str, Path]:
    return {agent.name: agent.source_path for agent in deployment.agents}


def test_programs_are_found_in_jacamos_folders(folder: Path, load: Load) -> None:
    agt = folder / "src" / "agt"
    (agt / "team").mkdir()
    for path in (agt / "inc" / "dora.asl", folder / "emil.asl", agt / "team" / "fritz-1.asl"):
        path.write_text("", encoding="utf-8")
    deployment = load("""\
        mas m {
          agent bob agent dora agent emil : file:emil.asl
          agent fritz : team/fritz-1 agent gerd : "src/agt/bob.asl"
        }
    """)
    assert by_name(deployment) == {
        "bob": agt / "bob.asl",
        "dora": agt / "inc" / "dora.asl",
        "emil": folder / "emil.asl",
        "fritz": agt / "team" / "fritz-1.asl",
        "gerd": agt / "bob.asl",
    }


def test_an_asl_path_comes_before_the_default_folders(folder: Path, diagnostics: Diagnostics) -> None:
    (folder / "own").mkdir()
    (folder / "own" / "dora.asl").write_text("", encoding="utf-8")
    text = 'mas m {\n agent dora\n agent zoe\n asl-path: own, "more"\n "$jacamoJar/test/jacamo/inc"\n}'
    (found,) = diagnostics(text)
    assert found.message == "program of agent `zoe` not found: zoe.asl"
    assert found.help is not None
    assert found.help.startswith(f"expected in {folder / 'own'}, {folder / 'more'}, {folder}")


def test_programs_are_not_read_over_the_network(diagnostics: Diagnostics) -> None:
    (found,) = diagnostics('mas m {\n agent bob : "http://far.example/bob.asl"\n}')
    assert found.help == "download the program: only files are supported"


def test_used_projects_have_folders_of_their_own(folder: Path, load: Load, write: Write) -> None:
    lib = folder / "lib"
    lib.mkdir()
    for name in ("dora.asl", "house.yaml"):
        write("", f"lib/{name}")
    write('mas base {\n agent dora\n workspace w\n world: "house.yaml"\n}', "lib/base.jcm")
    write("mas mine uses lib/base {\n agent bob\n}", "mine.jcm")
    deployment = load('mas m uses mine, "lib/base.jcm" {\n agent alice { join: w }\n}')
    agt = folder / "src" / "agt"
    assert by_name(deployment) == {
        "dora": lib / "dora.asl",
        "bob": agt / "bob.asl",
        "alice": agt / "alice.asl",
    }
    assert [workspace.name for workspace in deployment.workspaces] == ["w"]
    assert deployment.world == str(lib / "house.yaml")
    assert deployment.ignored == ()


def test_projects_that_use_each_other_are_refused(errors: Errors, write: Write) -> None:
    write("mas one uses two {\n agent bob\n}", "one.jcm")
    write("mas two uses one {\n agent alice\n}", "two.jcm")
    found = errors("mas m\n uses one, three {\n}")
    assert found == [(2, "project not found: `three`"), (1, "project `one` uses itself")]


def test_a_used_project_is_checked_with_the_one_that_uses_it(folder: Path, write: Write) -> None:
    agents = write("mas agents {\n agent bob { join: w }\n}", "agents.jcm")
    write("mas whole uses agents {\n workspace w\n}", "whole.jcm")
    found = check_files([folder]).diagnostics
    assert [each for each in found if each.severity != "note"] == []
    assert [each.message for each in check_files([agents]).diagnostics] == ["unknown workspace `w`"]


def test_values_are_separated_by_line_ends_or_commas(load: Load) -> None:
    deployment = load("""\
        mas m{
          agent bob{
            beliefs: calc("4+2*2")[id(0)], calc("1, 2")[id(1)]//, left_out(1)
                     names(["a", b], x)
                     ~agent(x)    // not a section
            goals :  start("a1","t(paris, athens)")
                     start(
                       "a2", [1,
                        2])
            focus: w.one
            focus: ns::w.two, one
            ag-arch: x.First("a, b") x.Second
                     x.Third
            mine: 3 text: "one, two"
          }
          workspace w {
            artifact one: A(02, -1, 2.5e3, 'a b')   /* blanks */
            artifact two: b.B
          }
        }
        """)
    (bob,) = deployment.agents
    assert bob.beliefs == 'calc("4+2*2")[id(0)], calc("1, 2")[id(1)], names(["a", b], x), ~agent(x)'
    assert " ".join(bob.goals.split()) == 'start("a1","t(paris, athens)"), start( "a2", [1, 2])'
    assert bob.focus == (FocusSpec("one", "w"), FocusSpec("two", "w", "ns"))
    assert [each.message for each in deployment.ignored] == [
        (
            "the architecture `x.First`, the architecture `x.Second` and the architecture `x.Third` have no effect: "
            "JaCaROS runs no architectures of projects (lines 12, 13)"
        )
    ]
    assert bob.options == {"mine": "3", "text": "one, two"}
    arguments = deployment.workspaces[0].artifacts[0].arguments
    assert arguments == (2, -1, 2500.0, "a b")
    assert type(arguments[3]) is Atom


def test_agents_may_have_names_of_sections_and_keys(load: Load) -> None:
    deployment = load("""\
        mas m {
          agent agent : bob.asl
          agent node : bob.asl { focus: w.group  beliefs: workspace(w), goals }
          workspace w { artifact group : A  agents: agent, node }
        }
        """)
    assert list(by_name(deployment)) == ["agent", "node"]
    assert deployment.agents[1].beliefs == "workspace(w), goals"
    assert [agent.join for agent in deployment.agents] == [("w",), ("w",)]


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("agent bob { beliefs: !start }", "expected a belief, found the goal `!start`"),
        (
            "agent bob { beliefs: p(X) :- q(X) }",
            "invalid belief `p(X) :- q(X)`: expected the end of the text, found `:-`",
        ),
        ("agent bob { instances: 0 }", "expected a number or names of agents as `instances`"),
        ("agent bob { ag-class: a.B c.D }", "duplicate key `ag-class`: an agent has only one"),
        ("agent bob { ag-class: }", "expected the class for `ag-class`, found `}`"),
        ("agent bob { roles: cook }", "expected `in`, found `}`"),
        ("agent bob { focus: ns:: }", "expected the name of an artifact, found `}`"),
        ("agent bob { join: w\n focus w.a\n }", "missing `:` after `focus`"),
        ("agent bob : bob.asl x", "unexpected `x` after agent `bob`"),
        ("workspace w { artifact a : A(3f) }", "expected a value, found `3f`"),
        ("workspace w { artifact a : A { focused: bob } }", "unknown key `focused` in an artifact"),
        ("workspace w { artifact console : A }", "`console` is a standard artifact of every workspace"),
        ("workspace w { artifact a : A artifact a : B }", "duplicate artifact `a`"),
        ("workspace w { parent: v }", "unknown workspace `v`"),
        ("workspace w { parent: /v }", "unknown workspace `/v`"),
        ("workspace w { parent: v } workspace v { parent: w }", "workspace `w` is its own ancestor"),
        ("workspace w workspace w", "duplicate workspace `w`"),
        ("workspace a/w workspace b/w agent bob { join: w }", "ambiguous workspace `w`"),
        ("uses packages: x", "expected `package`, found `packages`"),
        ("node n @", "expected the address of the node, found `}`"),
        ("platform:", "expected a platform after `platform:`, found `}`"),
        ("asl-path:", "expected a value after `asl-path:`, found `}`"),
        ("agent bob { goals: start } }", "unexpected `}` after the end of the system"),
    ],
)
def test_each_mistake_has_a_message(text: str, told: str, errors: Errors) -> None:
    assert told in [message for _, message in errors(f"mas m {{\n {text}\n}}")]


def test_after_an_error_the_rest_of_the_block_is_read(errors: Errors) -> None:
    found = errors("""\
        mas m { agent bob { roles: cook at home
            join: nowhere
            instances: Three }
          workspace w { artifact a = A
            artifact b : B(1, ]
            parent: nowhere }
          agent alice { join: w }
        }
        """)
    assert [line for line, _ in found] == [1, 2, 3, 4, 5, 6]


def test_a_run_warns_once_for_each_kind_and_the_checker_reports_everything(write: Write) -> None:
    path = write("""\
        mas m {
          agent bob { roles: cook in o.kitchen @ n1, waiter in o.hall
                      join: o
                      focus: i.i_art, far.table @ n1
                      debug: mindinspector(gui(cycle,html)) }
          agent alice { roles: guest in o.hall }
          workspace w { host: n2 debug }
          institution i : src/org/i.sai { workspaces: w debug k: 3 }
          organisation o : src/org/o.xml {
            group all : t { players: alice guest, bob cook  group inner : u { owner: bob debug: all } }
            scheme s1 : work { debug owner: bob k: "v" }
          }
          class-path: bin/classes, ../lib/x.jar   org-path: src/org
          platform: jade("-gui -port 1") local(pool,4)
                    jacamo.platform.EnvironmentWebInspector("false")
          uses package: lib "org.x:lib:1.0"
          node n1 running @ 10.1.1.17:30
          node n2
        }
        """)
    reading = read_project(path)
    assert {(each.severity, each.code) for each in reading.diagnostics} == {("warning", "no-effect")}
    assert len(reading.diagnostics) == 13
    told = [each.message for each in load_deployment(path).ignored]
    assert len(told) == 7, told
    roles = "the role `cook` in `o.kitchen`, the role `waiter` in `o.hall` and the role `guest` in `o.hall`"
    assert told[0] == f"{roles} have no effect: roles in organisations are not supported (lines 2, 6)"
    assert "the platform `jade` has no effect: nodes distribute agents" in told
    assert load_deployment(path).agents[0].focus == (FocusSpec("table", "/main/far"),)


def test_a_mas2j_file_reports_what_has_no_effect(folder: Path, write: Write) -> None:
    path = write("""\
        MAS m {
          infrastructure: Jade(main_container_host("localhost"))
              /* a comment */
          environment: x.Env(
              "a.jar",     // first
              map(f,"b")) at "h0"
          executionControl: x.Control
          agents:
              bob  at "10.1.1.1:7447" #2;   // two
              alice [beliefs="at(home)",
                     goals="start(\\"a\\",\\"b\\")"]
                  agentArchClass x.A
                  agentArchClass jaca.CAgentArch
                  beliefBaseClass x.Chain(
                      x.One,
                      x.Two("p(key,_)") // last
                  );
              carl
                  src/agt/bob.asl;
          directives: ld = x.Directive; le = x.Other;
          aslSourcePath: "one"; "two";
        }
        """)
    deployment = load_deployment(path)
    alice = deployment.agents[2]
    assert (alice.beliefs, alice.goals) == ("at(home)", 'start("a","b")')
    assert deployment.agents[3].source_path == folder / "src" / "agt" / "bob.asl"
    assert [(node.name, node.address) for node in deployment.nodes] == [
        ("h0", "h0"),
        ("10-1-1-1-7447", "10.1.1.1:7447"),
    ]
    assert [each.node for each in deployment.agents] == ["10-1-1-1-7447"] * 2 + [None] * 2
    assert [each.message for each in deployment.ignored] == [
        "the infrastructure `Jade` has no effect: nodes distribute agents",
        "the environment `x.Env` has no effect: Java environments are not supported",
        "`executionControl` and `directives` have no effect: JaCaROS runs no Java code (lines 7, 20)",
        "the architecture `x.A` has no effect: JaCaROS runs no architectures of projects",
        "the belief base `x.Chain` has no effect: JaCaROS runs no belief bases of projects",
    ]


def test_misspelt_keys_of_a_mas2j_file_are_reported(load: Load) -> None:
    text = "MAS m {\n agents:\n bob agentarchclass x.Y;\n alice agentclas x.Y;\n}"
    with pytest.raises(ProjectError) as refused:
        load(text)
    assert [(each.message, each.help) for each in refused.value.diagnostics] == [
        ("unexpected `agentarchclass`", "did you mean `agentArchClass`?"),
        ("unexpected `agentclas`", "did you mean `agentClass`?"),
    ]


def test_keys_similar_to_known_ones_are_reported(diagnostics: Diagnostics) -> None:
    found = diagnostics("mas m {\n agent bob { goal: start verbose: 1 verbose: 2 }\n asl-pth: x\n}")
    assert [(each.severity, each.message, each.help) for each in found] == [
        ("warning", "unknown key `goal`, kept as a parameter of the agent", "did you mean `goals`?"),
        ("warning", "duplicate key `verbose`: only the last value has an effect", None),
        ("error", "unknown section `asl-pth` in a .jcm file", "did you mean `asl-path`?"),
    ]
