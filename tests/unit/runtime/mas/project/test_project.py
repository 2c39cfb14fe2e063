"""Project files."""

from collections.abc import Callable
from pathlib import Path

import pytest

from jacaros.artifacts.env.values import Atom, Structure
from jacaros.runtime.mas.deployment import AgentSpec, Deployment, FocusSpec, ProjectError
from jacaros.runtime.mas.launch import load_deployment

TESTS = Path(__file__).parents[4]
PROGRAMS = ("bob", "alice", "carl")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name in PROGRAMS:
        (tmp_path / f"{name}.asl").write_text("!start.\n", encoding="utf-8")
    return tmp_path


Load = Callable[[str], Deployment]
Report = Callable[[str], str]


def located(text: str) -> list[tuple[str, str]]:
    """Place and message of each error of a report."""
    heads = [line.split(": error: ") for line in text.splitlines() if ": error: " in line]
    return [(place.split(":", 1)[1], message) for place, message in heads]


def agent(deployment: Deployment, name: str) -> AgentSpec:
    return next(agent for agent in deployment.agents if agent.name == name)


def names(deployment: Deployment) -> list[str]:
    return [agent.name for agent in deployment.agents]


def test_a_lone_program_is_a_system_of_one_agent(folder: Path) -> None:
    deployment = load_deployment(folder / "bob.asl")
    assert names(deployment) == ["bob"]
    assert deployment.agents[0].source_path == folder / "bob.asl"
    assert deployment.artifact_environment


def test_missing_and_unknown_files_are_refused(folder: Path) -> None:
    for name in ("no.asl", "no.jcm", "no.mas2j", "notes.txt"):
        with pytest.raises(ProjectError):
            load_deployment(folder / name)


def test_all_mas2j_files_of_the_conformance_cases_are_read() -> None:
    files = sorted(TESTS.glob("conformance*/**/*.mas2j"))
    assert len(files) > 50
    for path in files:
        deployment = load_deployment(path)
        assert deployment.agents, path
        assert deployment.ignored == (), path
        assert deployment.artifact_environment == ("conformance_environment" in path.parts)


def test_all_of_an_agent_in_mas2j(folder: Path, load: Load) -> None:
    deployment = load("""
        /* a system */
        MAS rescue {
            infrastructure: Local(pool,4) environment: jaca.CartagoEnvironment
            agents:
                bob carl.asl [verbose=2, beliefs="p(1), q(\\"x\\")", goals="go", events=requeue]
                    agentArchClass jaca.CAgentArch, jason.x.Arch(1)
                    beliefBaseClass jason.bb.TextPersistentBB("f.txt") at "host1";
                alice #2;
                carl [ mindinspector="gui(cycle,html,history)" ];  // a comment
            aslSourcePath: "src"; "more";
        }
        """)
    bob = agent(deployment, "bob")
    assert bob.source_path == folder / "carl.asl"
    assert bob.options == {"verbose": "2", "events": "requeue"}
    assert (bob.beliefs, bob.goals) == ('p(1), q("x")', "go")
    assert names(deployment) == ["bob", "alice1", "alice2", "carl"]
    assert agent(deployment, "alice2").declared_name == "alice"
    assert agent(deployment, "alice2").source_path == folder / "alice.asl"
    assert deployment.name == "rescue"
    assert deployment.environment == "jaca.CartagoEnvironment"
    assert deployment.artifact_environment
    assert deployment.source_paths[:2] == (folder / "src", folder / "more")


def test_programs_are_found_in_the_source_paths(folder: Path, load: Load) -> None:
    for path in (folder / "lib" / "dora.asl", folder / "src" / "asl" / "emil.asl"):
        path.parent.mkdir(parents=True)
        path.write_text("", encoding="utf-8")
    deployment = load('MAS m { agents: dora; emil; aslSourcePath: "lib"; }')
    assert agent(deployment, "dora").source_path == folder / "lib" / "dora.asl"
    assert agent(deployment, "emil").source_path == folder / "src" / "asl" / "emil.asl"


def test_a_world_can_be_named_in_both_formats(folder: Path, load: Load) -> None:
    (folder / "lab.yaml").write_text("", encoding="utf-8")
    assert load('MAS m { agents: bob; world: "lab.yaml" }').world == str(folder / "lab.yaml")
    assert load("MAS m { world: house agents: bob; }").world == "house"
    assert load('mas m { agent bob world: "lab.yaml" }').world == str(folder / "lab.yaml")


def test_java_parts_are_skipped_with_a_warning(load: Load) -> None:
    deployment = load("""
        MAS m {
            environment: mars.MarsEnv(gui, 3)
            executionControl: jason.control.ExecutionControl
            agents: bob agentClass my.Agent;
            directives: id=my.Directive;
            classpath: "lib/*.jar"; "b.jar";
        }
        """)
    assert [warning.message for warning in deployment.ignored] == [
        "the environment `mars.MarsEnv` has no effect: Java environments are not supported",
        "`executionControl`, `directives` and `classpath` have no effect: JaCaROS runs no Java code (lines 4, 6, 7)",
    ]
    assert deployment.environment == "mars.MarsEnv(gui, 3)"
    assert not deployment.artifact_environment


def test_errors_of_a_mas2j_file_are_reported_together(report: Report) -> None:
    text = """\
        MAS m {
            agents: bob
                    dick;
                    Carl;
                    dora;
                    bob [beliefs="p(", verbose 2];
            agentz: x;
        }
        """
    assert located(report(text)) == [
        ("3:13", "missing `;` after agent `bob`"),
        ("4:13", "the name of an agent must begin with a lower-case letter"),
        ("4:13", "program of agent `Carl` not found: Carl.asl"),
        ("5:13", "program of agent `dora` not found: dora.asl"),
        ("6:40", "expected `=`, found `2`"),
        ("7:5", "unknown section `agentz` in a .mas2j file"),
    ]


def test_wrong_options_are_reported_at_their_line(report: Report) -> None:
    text = """\
        MAS m {
            agents: bob [events=discord, intBels=here,
                         verbose=9, tro=yes];
                    carl [nrcbp=0, own="anything"];
                    bob2 bob.asl [urgency="bump 10"];
        }
        """
    assert located(report(text)) == [
        ("2:25", "expected one of discard, requeue, retrieve as `events`, found `discord`"),
        ("2:42", "expected one of sameFocus, newFocus as `intBels`, found `here`"),
        ("3:26", "expected one of 0, 1, 2 as `verbose`, found `9`"),
        ("3:33", "expected one of true, false as `tro`, found `yes`"),
        ("4:25", "expected a positive integer as `nrcbp`, found `0`"),
        ("5:35", "expected urgencies of events, found `bump 10`"),
    ]


def test_options_without_effect_cause_a_warning(load: Load) -> None:
    options = 'mindinspector="web(ms,100)", cycles_act=2, synchronised=true, own=x'
    assert [warning.message for warning in load(f"MAS m {{ agents: bob [{options}]; }}").ignored] == [
        "the option `mindinspector` has no effect: use --view or --record instead",
        "the option `cycles_act` has no effect: every cycle has each stage once",
        "the option `synchronised` has no effect: agents always take turns",
    ]


def test_an_error_shows_the_line_and_a_fix(report: Report) -> None:
    assert report("MAS m {\n    agents: bob\n            alice;\n}\n") == (
        "p.mas2j:3:13: error: missing `;` after agent `bob`\n  3 |             alice;\n"
        "    |             ^^^^^\n  = help: end each agent with `;`"
    )


def test_all_of_an_agent_in_jcm(folder: Path, load: Load) -> None:
    deployment = load("""
        mas rescue {
          agent bob : carl.asl {
            beliefs: friend(alice), price("a, b",10)[source(self)]
                     money(5)
            goals:   start, go(X)
            ag-class: my.Agent
            ag-arch:  a.Arch, b.Arch(1)
            ag-bb-class: my.BB(x)
            verbose: 2
            debug: mindinspector(web)
          }
          agent alice
        }
        """)
    bob = agent(deployment, "bob")
    assert bob.source_path == folder / "carl.asl"
    assert bob.beliefs == 'friend(alice), price("a, b",10)[source(self)], money(5)'
    assert bob.goals == "start, go(X)"
    assert bob.agent_class == "my.Agent"
    assert bob.options == {"verbose": "2", "debug": "mindinspector(web)"}
    assert agent(deployment, "alice").source_path == folder / "alice.asl"
    assert deployment.artifact_environment


def test_instances_are_numbered_or_named(folder: Path, load: Load) -> None:
    deployment = load("""
        mas m { agent bob { instances: 3 } agent alice { instances: ann amy } agent carl { instances: 1 } }
    """)
    assert names(deployment) == ["bob1", "bob2", "bob3", "ann", "amy", "carl"]
    assert agent(deployment, "amy").source_path == folder / "alice.asl"


def test_workspaces_and_artifacts_are_kept_in_order(load: Load) -> None:
    deployment = load("""
        mas m {
          agent bob
          workspace lab {
            artifact counter : tools.Counter(-3, 2.5, true, "12", kitchen, [1, [a]], p(q, "r"))
            artifact clock : Clock() { focused-by: bob }
            artifact arm : "my.Arm"
            parent: house
          }
          workspace house { artifact bell : Bell }
        }
        """)
    assert [workspace.name for workspace in deployment.workspaces] == ["house", "lab"]
    lab = deployment.workspaces[1]
    assert lab.parent == "house"
    declared = {artifact.name: artifact.type_name for artifact in lab.artifacts}
    assert declared == {"counter": "tools.Counter", "clock": "Clock", "arm": "my.Arm"}
    assert list(declared) == ["counter", "clock", "arm"]
    arguments = lab.artifacts[0].arguments
    nested = ([1, [Atom("a")]], Structure("p", (Atom("q"), "r")))
    assert arguments == (-3, 2.5, True, "12", Atom("kitchen"), *nested)
    assert [type(argument) for argument in arguments[:5]] == [int, float, bool, str, Atom]
    assert lab.artifacts[1].focused_by == ("bob",)


def test_agents_join_and_focus_from_both_sides(load: Load) -> None:
    deployment = load("""
        mas m {
          agent bob { instances: 2 join: house  focus: lab.clock, ns::bell }
          agent alice agent carl
          workspace lab { artifact clock : Clock { focused-by: alice, other::bob2 } agents: carl }
          workspace house { artifact bell : Bell { focused-by: * } }
        }
        """)
    clock, bell = FocusSpec("clock", "lab"), FocusSpec("bell", "house")
    assert agent(deployment, "bob1").join == ("house", "lab")
    assert agent(deployment, "bob1").focus == (clock, FocusSpec("bell", "house", "ns"), bell)
    assert agent(deployment, "bob2").focus[2] == FocusSpec("clock", "lab", "other")
    assert agent(deployment, "alice").focus == (clock, bell)
    assert agent(deployment, "alice").join == ("lab", "house")
    assert agent(deployment, "carl").join == ("lab", "house")
    assert deployment.ignored == ()


def test_blocks_may_stand_on_one_line(load: Load) -> None:
    text = "mas m { agent bob { goals: start, go } agent alice { beliefs: p goals: q } workspace w }"
    deployment = load(text)
    assert names(deployment) == ["bob", "alice"]
    assert agent(deployment, "bob").goals == "start, go"
    assert (agent(deployment, "alice").beliefs, agent(deployment, "alice").goals) == ("p", "q")
    assert deployment.workspaces[0].name == "w"


def test_asl_paths_are_searched(folder: Path, load: Load) -> None:
    (folder / "deep" / "er").mkdir(parents=True)
    (folder / "deep" / "er" / "dora.asl").write_text("", encoding="utf-8")
    deployment = load('mas m { agent dora  agent bob\n asl-path: deep, "deep/er" }')
    assert agent(deployment, "dora").source_path == folder / "deep" / "er" / "dora.asl"


def test_used_projects_come_first(folder: Path, load: Load, report: Report) -> None:
    (folder / "base.jcm").write_text("mas base { agent alice workspace w }", encoding="utf-8")
    deployment = load('mas m uses "base.jcm" { agent bob }')
    assert names(deployment) == ["alice", "bob"]
    assert [workspace.name for workspace in deployment.workspaces] == ["w"]
    assert "uses itself" in report('mas m uses "p.jcm" { agent bob }')


def test_unsupported_declarations_are_skipped_with_a_warning(load: Load) -> None:
    deployment = load("""
        mas m {
          agent bob { roles: worker in o.g1 }
          workspace w { artifact a : A  debug }
          institution i : i.sai { workspaces: w }
          organisation o : org.xml { group g1 : team { players: bob worker } }
          platform: local(pool,4)
          uses package: lib "a:b:1"
        }
        """)
    assert [warning.message for warning in deployment.ignored] == [
        "the role `worker` in `o.g1` has no effect: roles in organisations are not supported",
        "`debug` of workspace `w` has no effect: JaCaROS opens no windows",
        "the institution `i` has no effect: institutions are not supported",
        "the organisation `o` has no effect: organisations are not supported",
        "the package `lib` has no effect: Java packages are not supported",
    ]
    assert all(warning.severity == "warning" for warning in deployment.ignored)


def test_misspelt_names_are_reported_with_a_suggestion(report: Report) -> None:
    text = """\
        mas m {
          agent bob { instances: 2  join: lap  focus: clok, lab.bell }
          workspace lab { artifact clock : Clock { focused-by: bop } }
        }
        """
    found = report(text)
    unknown = [("2:35", "workspace `lap`"), ("2:47", "artifact `clok`"), ("3:56", "agent `bop`")]
    assert located(found) == [(place, f"unknown {what}") for place, what in unknown]
    assert [line.removeprefix("  = help: ") for line in found.splitlines() if "= help: " in line] == [
        "did you mean `lab`?",
        "did you mean `clock`?",
        "the agent focuses it as soon as it is created",
        "did you mean `bob`?",
    ]


def test_errors_of_a_jcm_file_are_reported_together(report: Report) -> None:
    text = """\
        mas m {
          agent dora
          agent bob { beliefs: p( }
          agent alice { goals start }
          workspace w {
            artifact a : A(1, 2
            artifact b
          }
          workspace W
          agnt x
          agent carl
          agent carl
        }
        """
    assert located(report(text)) == [
        ("2:9", "program of agent `dora` not found: dora.asl"),
        ("3:24", "invalid belief `p(`: expected a term, found the end of the file"),
        ("4:17", "missing `:` after `goals`"),
        ("7:5", "expected `,`, found `artifact`"),
        ("8:3", "expected `:`, found `}`"),
        ("9:13", "the name of a workspace must begin with a lower-case letter"),
        ("10:3", "unknown section `agnt` in a .jcm file"),
        ("12:9", "duplicate agent `carl`"),
    ]


def test_wrong_beliefs_are_reported_at_their_line(report: Report) -> None:
    assert "p.jcm:3:" in report("mas m {\n agent bob {\n beliefs: p(1), q(2]\n }\n}")
    assert report('MAS m {\n agents:\n bob [goals="go(else)"];\n}').startswith(
        "p.mas2j:3:13: error: invalid goal `go(else)`: reserved word `else` used as a name"
    )


JCM = """mas m uses "x.jcm" { agent bob : bob.asl { beliefs: p(1), "s" focus: n::w.a } workspace w {
artifact a : A(1,[x],"y") { focused-by: * } } organisation o : f { g } platform: l(1) }"""
MAS2J = """MAS m { environment: a.B(c) agents: bob x.asl [a=b, beliefs="p(1)"] agentClass q.r #3;
aslSourcePath: "."; classpath: "x"; }"""


@pytest.mark.parametrize(("name", "whole"), [("p.jcm", JCM), ("p.mas2j", MAS2J)])
def test_every_beginning_of_a_file_gives_diagnostics(write: Callable[..., Path], name: str, whole: str):
    for end in range(len(whole)):
        path = write(whole[:end], name)
        with pytest.raises(ProjectError):
            load_deployment(path)
