"""The artifacts that every workspace has, as agents use them."""

import re

from body_lab import Robot, action, among_artifacts, detail_of, message_of, reason_of

from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import NIL, Term, Var, atom, list_items, structure


def seen(robot: Robot, name: str) -> list[str]:
    """The percept beliefs of that name that a robot has, with references left out."""
    held: list[str] = []
    for percept in robot.percepts:
        shown = re.sub(r"cobj_\d+", "ID", text(percept.literal))
        if shown.startswith(f"{name}("):
            if percept.kind == "add":
                held.append(shown)
            else:
                held.remove(shown)
    return held


def annotations(robot: Robot, name: str) -> list[str]:
    """The annotations of the last percept of that name, with references left out."""
    last = next(p for p in reversed(robot.percepts) if text(p.literal).startswith(f"{name}("))
    return [re.sub(r"cobj_\d+", "ID", text(annotation)) for annotation in last.annotations]


@among_artifacts
async def test_the_workspace_shows_what_is_in_it(one, two, clock):
    workspace = one.ask("lookupArtifact", "workspace")
    one.do("focus", workspace)
    default = ["blackboard", "console", "manrepo", "system", "workspace"]
    names = [re.findall(r'ID,"(\w+)"', each)[0] for each in seen(one, "artifact")]
    assert names == [*default, "session_one", "body_one"]
    made = two.make("c", "Counter")
    assert seen(one, "artifact")[-1] == 'artifact(ID,"c","Counter")'
    two.do("disposeArtifact", made)
    assert 'artifact(ID,"c","Counter")' not in seen(one, "artifact")
    two.do("createWorkspace", "lab")
    two.do("linkWorkspace", "lab", "shortcut")
    assert seen(one, "childWsp") == ['childWsp("lab")']
    assert seen(one, "linkedWsp") == ['linkedWsp("shortcut","/main/lab")']
    assert annotations(one, "childWsp")[1:] == [
        "artifact_name(workspace)",
        "percept_type(obs_prop)",
        "source(percept)",
        'workspace("/main",ID)',
    ]


@among_artifacts
async def test_what_an_agent_focuses_is_a_property_of_its_body(one, two, clock):
    c, d = one.make("c", "Counter"), one.make("d", "Counter")
    one.do("focus", c)
    assert annotations(one, "focusing") == [
        "artifact_id(ID)",
        "artifact_name(body_one)",
        "percept_type(obs_prop)",
        "source(percept)",
        'workspace("/main",ID)',
    ]
    body = two.ask("lookupArtifact", "body_one")
    two.do("focus", body)
    two.percepts = [p for p in two.percepts if "body_one" not in text(p.literal)]
    assert seen(two, "focusing") == ['focusing(ID,c,"Counter",ID,main,"/main")']
    one.do("focus", d)
    assert seen(two, "focusing")[1:] == ['focusing(ID,d,"Counter",ID,main,"/main")']
    one.do("stopFocus", c)
    two.do("disposeArtifact", d)
    assert seen(two, "focusing") == seen(one, "focusing") == []


@among_artifacts
async def test_an_agent_sees_its_own_body_and_session_once(one, two, clock):
    one.do("focus", one.make("c", "Counter"))
    before = len(one.percepts)
    for name in ("body_one", "session_one"):
        assert one.do("focus", one.ask("lookupArtifact", name)).success
    assert len(one.percepts) == before


@among_artifacts
async def test_where_an_agent_is_is_a_property_of_its_session(one, two, clock):
    one.do("createWorkspace", "lab")
    two.do("focus", two.ask("lookupArtifact", "session_one"))
    lab = one.ask("joinWorkspace", "lab")
    others = [p for p in two.percepts if "session_one" in "".join(map(text, p.annotations))]
    assert [re.sub(r"cobj_\d+", "ID", text(p.literal)) for p in others] == [
        'joinedWsp(ID,main,"/main")',
        'joinedWsp(ID,lab,"/main/lab")',
    ]
    assert "artifact_name(session_one)" in annotations(one, "joinedWsp")
    one.do("quitWorkspace", lab)
    assert text(two.percepts[-1].literal).endswith('lab,"/main/lab")')
    assert two.percepts[-1].kind == "remove"
    assert reason_of(one.do("lookupArtifact", "/main/lab/body_one", Var())) == (
        'artifact_not_available("body_one")'
    )


@among_artifacts
async def test_actions_may_be_directed_to_the_default_artifacts(one, two, clock):
    one.do("createWorkspace", "lab")
    one.do("joinWorkspace", "lab")
    one.do("joinWorkspace", "/main")
    making = one.begin(action("makeArtifact", "c", "Counter", artifact_name="workspace", wsp="lab"))
    await clock.sleep(0)
    assert one.completions[making].success
    c = one.ask("lookupArtifact", "lab/c")
    assert c.value.creator == "one"
    workspace = one.ask("lookupArtifact", "/main/lab/workspace")
    assert text(one.ask("lookupArtifact", "c", artifact_id=workspace)) == text(c)
    body = one.ask("lookupArtifact", "/main/lab/body_one")
    assert one.do("focusWhenAvailable", "c", artifact_id=body).success
    assert one.beliefs == ["count(0)"]
    assert one.do("stopFocus", c, artifact_id=body).success
    assert one.beliefs == []
    session = one.ask("lookupArtifact", "session_one")
    assert one.do("joinWorkspace", "lab", artifact_id=session).success
    assert one.do("joinWorkspace", "/main", aid=session).success


@among_artifacts
async def test_a_body_obeys_its_owner_only(one, two, clock):
    c = one.make("c", "Counter")
    two.do("println")
    body = one.ask("lookupArtifact", "body_two")
    assert reason_of(one.do("focus", c, artifact_id=body)) == 'security_exception("one","body_two")'
    session = one.ask("lookupArtifact", "session_two")
    assert reason_of(one.do("quitFromEnvironment", artifact_id=session)) == (
        'security_exception("one","session_two")'
    )
    assert two.beliefs == []


@among_artifacts
async def test_an_own_body_does_only_what_a_body_does(one, two, clock):
    body = one.ask("lookupArtifact", "body_one")
    assert reason_of(one.do("joinWorkspace", "/main", artifact_id=body)).startswith("unknown_operation(")


@among_artifacts
async def test_make_artifact_obeys_the_workspace_that_it_is_directed_to(one, two, clock):
    one.do("createWorkspace", "lab")
    lab = one.ask("joinWorkspace", "lab")
    one.do("joinWorkspace", "/main")
    assert one.do("makeArtifact", "a", "Counter", wid=lab).success
    assert one.do("makeArtifact", "b", "Counter", wsp="/main/lab").success
    names = [text(n) for n in list_items(one.ask("getCurrentArtifacts", wid=lab))]
    assert names[5:] == ['"a"', '"b"', '"body_one"']


@among_artifacts
async def test_workspaces_are_found_through_links(one, two, clock):
    for path in ("a", "a/deep", "b"):
        assert one.do("createWorkspace", path).success
    assert one.do("linkWorkspaces", "/main/b", "../main/a", "near").success
    assert one.do("joinWorkspace", "b/near/deep").success
    assert [w.path for w in one.body.workspaces.joined()] == ["/main", "/main/a/deep"]
    made = one.make("/main/b/near/c", "Counter")
    assert one.ask("lookupArtifact", "/main/a/c") is made
    assert one.do("createWorkspace", "/main/b/near/new").success
    assert one.do("joinWorkspace", "/main/a/new").success
    one.do("joinWorkspace", "/main/a")
    assert one.do("makeArtifact", "d", "Counter", wsp="/main/b/near").success
    assert one.ask("lookupArtifact", "d", wsp="../b/near").value.workspace == "/main/a"
    assert detail_of(one.do("println", wsp="/main/b")) == 'workspace_not_joined("/main/b")'
    assert reason_of(one.do("linkWorkspace", "/main/a", "/main/b/near")) == (
        'workspace_already_present("/main/b/near")'
    )
    assert reason_of(one.do("linkWorkspace", "/main/nowhere", "x")) == 'unknown_workspace("/main/nowhere")'
    assert reason_of(one.do("linkWorkspaces", "/main/x", "/main/a", "y")) == 'unknown_workspace("/main/x")'
    assert reason_of(one.do("createWorkspace", "/main/x/y")) == 'unknown_workspace("/main/x")'


@among_artifacts
async def test_what_needs_other_processes_says_so(one, two, clock):
    for name, *arguments in (
        ("createWorkspace", "w", "http://lab.example"),
        ("createWorkspaceWithTopology", "w", "grid"),
        ("linkRemoteWorkspace", "/main/w", "web", "w"),
        ("mountWorkspace", "http://lab.example", "/main/w", "w"),
        ("spawnNode", "host"),
        ("crash",),
        ("shutdownNode",),
    ):
        failure = one.do(name, *arguments)
        assert reason_of(failure) == f'not_supported("{name}/{len(arguments)}")'
        assert len(message_of(failure)) > 20


@among_artifacts
async def test_quitting_ends_everything_in_a_workspace(one, two, clock):
    one.do("createWorkspace", "lab")
    lab = one.ask("joinWorkspace", "lab")
    inside = one.make("c", "Counter")
    one.do("focus", inside)
    assert one.do("quitWorkspace", lab).success
    assert seen(one, "count") == seen(one, "focusing") == []
    assert seen(one, "joinedWsp") == ['joinedWsp(ID,main,"/main")']
    assert detail_of(one.do("inc", artifact_id=inside)) == 'workspace_not_joined("/main/lab")'
    two.do("joinWorkspace", "lab")
    two.do("inc", artifact_id=inside)
    assert seen(one, "count") == []
    assert not one.do("inc").success
    assert one.do("joinWorkspace", "lab").success
    assert one.do("focus", inside).success
    assert seen(one, "count") == ["count(1)"]


@among_artifacts
async def test_an_agent_that_quit_the_environment_can_join_again(one, two, clock):
    one.do("focus", one.make("c", "Counter"))
    one.do("createWorkspace", "lab")
    one.do("joinWorkspace", "lab")
    assert one.do("quitFromEnvironment").success
    assert seen(one, "joinedWsp") == seen(one, "focusing") == seen(one, "count") == []
    for name, *arguments in (
        ("inc",),
        ("makeArtifact", "d", "Counter"),
        ("lookupArtifact", "c", Var()),
        ("focusWhenAvailable", "c"),
        ("quitWorkspace",),
        ("println", "x"),
    ):
        assert reason_of(one.do(name, *arguments)) == 'workspace_not_joined("/main")', name
    assert one.lines == []
    assert one.do("joinWorkspace", "/main").success
    assert one.do("inc").success


@among_artifacts
async def test_a_pattern_lets_pass_what_fits_it(one, two, clock):
    c = one.make("c", "Counter")
    assert one.do("focus", c, structure("count", 2.0)).success
    assert two.do("focus", c, term_list(atom("tick"))).success
    one.log.clear(), two.log.clear()
    for _ in range(3):
        one.do("inc")
    assert [line for line in one.log if line != "done"] == ["add count(2)", "remove count(2)"]
    assert two.log == ["signal tick"] * 3
    assert two.beliefs == []


def term_list(*items: Term) -> list[Term]:
    """A list, as `body_lab.term_of` takes it."""
    return list(items)


@among_artifacts
async def test_a_pattern_with_a_variable_fits_any_value(one, two, clock):
    c = one.make("c", "Counter", 5)
    assert one.do("focus", c, structure("count", Var())).success
    one.do("inc")
    assert one.beliefs == ["count(6)"]
    assert "signal tick" not in one.log
    one.do("stopFocus", c)
    assert one.beliefs == []


@among_artifacts
async def test_an_invalid_filter_is_a_wrong_argument(one, two, clock):
    c = one.make("c", "Counter")
    for wrong in (3, "count", NIL, [3]):
        failure = one.do("focus", c, wrong)
        assert "expected a filter: a pattern such as count(_)" in message_of(failure)
        assert reason_of(failure).startswith("wrong_op_arguments(")
    assert one.beliefs == []


@among_artifacts
async def test_actions_that_wait_can_be_given_a_time(one, two, clock):
    one.make("c", "Counter")
    waiting = one.begin(action("focusWhenAvailable", "late", timeout=500))
    taking = one.begin(action("take", timeout=200))
    in_time = one.begin(action("focusWhenAvailable", "soon", timeout=500))
    await clock.sleep(0.3)
    assert reason_of(one.completions[taking]) == 'operation_timeout("take/0",200)'
    two.make("soon", "Counter")
    assert one.completions[in_time].success
    await clock.sleep(0.3)
    assert reason_of(one.completions[waiting]) == 'operation_timeout("focusWhenAvailable/1",500)'
    assert message_of(one.completions[waiting]) == "focusWhenAvailable/1 did not end within 500 ms"
    two.make("late", "Counter", 7)
    assert one.beliefs == ["count(0)"]
    assert one.activity.pending == 0


@among_artifacts
async def test_an_invalid_time_is_refused(one, two, clock):
    for wrong in (atom("soon"), -1, Var("X")):
        failure = one.do("println", timeout=wrong)
        assert "timeout: expected a number of milliseconds" in message_of(failure)
        assert "unknown_annotation" in str(reason_of(failure))


@among_artifacts
async def test_two_agents_cannot_make_the_same_artifact(one, two, clock):
    one.do("println"), two.do("println")
    assert one.do("makeArtifact", "c", "Counter").success
    for name in ("c", "workspace", "body_one"):
        assert reason_of(two.do("makeArtifact", name, "Counter")) == (
            f'makeArtifactFailure("artifact_already_present","{name}")'
        )


@among_artifacts
async def test_a_manual_can_be_read(one, two, clock):
    assert "inc(by" in str(one.ask("getManualContent", "Counter"))
    unknown = one.do("getManualContent", "Countr", Var())
    assert reason_of(unknown) == 'makeArtifactFailure("unknown_artifact_template","Countr")'


@among_artifacts
async def test_the_artifacts_of_a_body_that_is_closed_are_gone(one, two, clock):
    one.do("println")
    body = two.ask("lookupArtifact", "body_one")
    two.do("focus", body)
    one.body.close()
    assert reason_of(two.do("focus", body)) == 'artifact_not_available("body_one")'
    assert not two.do("lookupArtifact", "session_one", Var()).success
