"""What agents do through their body: operations, artifacts, workspaces, and the artifacts that every workspace has."""

import re

from body_lab import Robot, action, among_artifacts, detail_of, message_of, reason_of

from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import NIL, Reference, Var, atom, list_items, structure


@among_artifacts
async def test_an_unknown_operation_is_reported_with_similar_ones(one, two, clock):
    one.make("motion", "Counter")
    failure = one.do("driv", 1)
    assert message_of(failure) == (
        "no artifact of workspace /main has an operation driv/1; did you mean `drive/1` of 'motion'?"
    )
    assert reason_of(failure) == 'env_failure(action_failed(driv,op(default,"( driv 1 )")))'
    assert detail_of(failure) == 'unknown_operation("driv/1")'
    failure = one.do("left::driv", "far away", [1, "a b"], Var("X"))
    assert reason_of(failure) == 'env_failure(action_failed(driv,op(left,"( driv far away [1,"a b"] X )")))'
    assert "did you mean `drive/1` of 'motion'?" in message_of(one.do("drive", 1, 2))
    assert "did you mean `makeArtifact/" in message_of(one.do("makeArtifat", "a", "Counter"))


@among_artifacts
async def test_guards_of_operations_are_awaited_dropped_and_paused(one, two, clock):
    one.make("c", "Counter")
    take = one.begin(action("take"))
    assert one.body.pending == (take,)
    assert one.activity.pending == 1
    two.do("inc", 1)
    assert one.completions[take].success
    assert one.activity.pending == 0
    take = one.begin(action("take"))
    one.body.cancel_act(take)
    one.body.cancel_act(take)
    two.do("inc", 1)
    assert take not in one.completions
    assert two.ask("read") == 1.0
    assert one.activity.pending == 0
    drive = one.begin(action("drive", 3))
    await clock.sleep(1.5)
    one.body.suspend_act(drive)
    await clock.sleep(100)
    assert drive not in one.completions
    one.body.resume_act(drive)
    await clock.sleep(5)
    assert one.completions[drive].success


@among_artifacts
async def test_a_closed_body_gives_everything_up(one, two, clock):
    one.do("focus", one.make("c", "Counter"))
    take = one.begin(action("take"))
    told = len(one.log)
    one.body.close()
    two.do("inc", 1)
    assert len(one.log) == told
    assert take not in one.completions
    assert one.activity.pending == 0


def count(robot: Robot, **directions: object) -> object:
    return robot.ask("read", **directions)


@among_artifacts
async def test_an_annotation_directs_the_action_by_any_name(one, two, clock):
    one.make("a", "Counter", 1)
    one.make("b", "Counter", 2)
    assert count(one, art=atom("b")) == count(one, artifact_id="b") == count(one, art="b", wsp="/main") == 2.0
    assert count(one, source=atom("self")) == 1.0


@among_artifacts
async def test_a_directed_action_without_target_fails_with_a_reason(one, two, clock):
    a = one.make("motor", "Counter", 1)
    assert "did you mean `motor`?" in message_of(one.do("read", Var(), artifact_name="moter"))
    failure = one.do("raed", Var(), artifact_id=a)
    assert "did you mean `read`" in message_of(failure)
    assert (reason_of(failure) or "").startswith("unknown_operation(cobj_")
    assert "the method `positive` of `motor` is not an operation" in message_of(one.do("positive"))
    assert "unknown annotation" in message_of(one.do("read", Var(), artefact_name="motor"))
    assert "expected an artifact" in message_of(one.do("read", Var(), artifact_id=3))
    assert "expected a workspace" in message_of(one.do("read", Var(), wid=a))
    for failure in (one.do("read", Var(), wsp="attic"), one.do("read", Var(), art="attic/c")):
        assert "attic has not been joined" in message_of(failure)
        assert reason_of(failure) == "env_failure(action_failed(read,generic_error))"
        assert (detail_of(failure) or "").startswith("workspace_not_joined(")
    failure = one.do("read", Var(), foo=3)
    assert reason_of(failure) == "action_failed(read(_)[foo(3)],unknown_annotation)"
    assert detail_of(failure) == 'unknown_annotation("foo(3)")'
    assert "did you mean `artifact_name`" in message_of(one.do("read", Var(), artefact_name="motor"))


@among_artifacts
async def test_an_action_for_the_artifacts_of_a_namespace_does_not_go_elsewhere_for_its_number_of_arguments(
    one, two, clock
):
    one.make("left", "Lamp")
    right = one.make("right", "Counter")
    one.make("total", "Total")
    one.do("ns::focus", right)
    failure = one.do("ns::inc", 1, 2)
    assert "unknown operation `inc/2` of artifact right (Counter); it has inc/" in message_of(failure)
    assert one.do("ns::inc", 1).success
    assert one.do("inc", 1, 2).success


@among_artifacts
async def test_the_name_of_an_artifact_may_be_a_path(one, two, clock):
    one.make("a", "Counter", 1)
    one.do("createWorkspace", "lab")
    one.do("joinWorkspace", "lab")
    one.make("a", "Counter", 2)
    assert count(one, artifact_name="/main/lab/a") == count(one, art="lab/a", wsp="/main") == 2.0
    assert count(one, art="../a") == count(one, art="a", wsp="main") == 1.0


@among_artifacts
async def test_an_exact_number_of_arguments_wins_over_any_number(one, two, clock):
    one.make("t", "Total")
    one.make("c", "Counter", 1)
    assert one.do("inc", 5).success
    assert count(one) == 6.0


@among_artifacts
async def test_ids_of_other_things_are_refused(one, two, clock):
    c = one.make("c", "Counter")
    assert "expected an artifact" in message_of(one.do("read", Var(), artifact_id=Reference(object())))
    assert "(lookupArtifact gives the id for a name), found c" in message_of(one.do("focus", atom("c")))
    for wrong in (atom("c"), "c", 7, Var("X")):
        assert without_ids(reason_of(one.do("focus", wrong))) == 'wrong_op_arguments(ID,"focus/1")'
    linked = one.do("linkArtifacts", "c", "out", c)
    assert without_ids(reason_of(linked)) == 'wrong_op_arguments(ID,"linkArtifacts/3")'


@among_artifacts
async def test_an_action_that_nothing_offers_names_the_joined_workspaces(one, two, clock):
    one.do("createWorkspace", "lab")
    one.do("joinWorkspace", "lab")
    assert "the workspaces /main/lab, /main has" in message_of(one.do("jump"))
    assert reason_of(one.do("joinWorkspace", "attic")) == 'unknown_workspace("/main/lab/attic")'


def without_ids(reason: str | None) -> str:
    """A reason in which ids do not matter."""
    assert reason is not None
    return re.sub(r"cobj_\d+", "ID", reason)


@among_artifacts
async def test_a_failed_creation_gives_the_reason(one, two, clock):
    one.make("c", "Counter")
    assert reason_of(one.do("makeArtifact", "c", "Counter")) == (
        'makeArtifactFailure("artifact_already_present","c")'
    )
    assert reason_of(one.do("makeArtifact", "d", "Countr")) == (
        'makeArtifactFailure("unknown_artifact_template","Countr")'
    )
    assert "did you mean `Counter`?" in message_of(one.do("makeArtifact", "d", "Countr"))
    assert (
        reason_of(one.do("makeArtifact", "e", "Counter", [1, 2])) == 'makeArtifactFailure("init_failed","e")'
    )
    assert "list of parameters" in message_of(one.do("makeArtifact", "e", "Counter", 1))
    wrong = one.do("makeArtifact", "e", "Counter", Var("Id"))
    assert "expected a list of parameters; the id is the fourth argument, found Id" in message_of(wrong)
    assert "expected a name" in message_of(one.do("makeArtifact", 3, "Counter"))
    assert without_ids(reason_of(wrong)) == 'wrong_op_arguments(ID,"makeArtifact/3")'


@among_artifacts
async def test_artifacts_are_found_by_type_or_with_a_spelling_suggestion(one, two, clock):
    made = one.make("c", "Counter")
    assert one.ask("lookupArtifactByType", "Counter") is made
    assert reason_of(one.do("lookupArtifactByType", "Lamp", Var())) == 'artifact_not_available("Lamp")'
    names = [text(name) for name in list_items(one.ask("getCurrentArtifacts"))]
    default = ['"blackboard"', '"console"', '"manrepo"', '"system"', '"workspace"']
    assert names == [*default, '"c"', '"session_one"', '"body_one"']
    one.make("motion", "Counter")
    failure = one.do("lookupArtifact", "moton", Var())
    assert "did you mean `motion`?" in message_of(failure)
    assert reason_of(failure) == 'artifact_not_available("moton")'


@among_artifacts
async def test_an_output_that_is_bound_is_a_wrong_argument(one, two, clock):
    c = one.make("c", "Counter")
    assert (
        without_ids(reason_of(one.do("lookupArtifact", "c", c)))
        == 'wrong_op_arguments(ID,"lookupArtifact/2")'
    )
    for wrong in (one.do("makeArtifact", "d", "Counter", [], c), one.do("joinWorkspace", "/main", c)):
        assert "is an output: expected an unbound variable, found cobj_" in message_of(wrong)
    assert not one.do("lookupArtifact", "d", Var()).success


@among_artifacts
async def test_focus_when_available_waits_and_can_be_cancelled(one, two, clock):
    waiting = one.begin(action("focusWhenAvailable", "d"))
    one.body.suspend_act(waiting)
    one.body.resume_act(waiting)
    one.body.cancel_act(waiting)
    two.make("d", "Counter", 2)
    assert one.beliefs == []
    assert waiting not in one.completions
    assert one.activity.pending == 0
    waiting = one.begin(action("focusWhenAvailable", "c"))
    assert waiting not in one.completions
    assert one.activity.pending == 1
    two.make("other", "Counter")
    two.make("c", "Counter", 2)
    assert one.completions[waiting].success
    assert one.beliefs == ["count(2)"]
    assert one.activity.pending == 0
    assert two.do("focusWhenAvailable", "c").success


@among_artifacts
async def test_a_path_names_an_artifact_and_projects_let_agents_focus(one, two, clock):
    one.do("createWorkspace", "lab")
    made = one.make("lab/c", "Counter", 5)
    assert one.ask("lookupArtifact", "/main/lab/c") is made
    assert one.ask("lookupArtifact", "../main/lab/c") is made
    assert not one.do("lookupArtifact", "c", Var()).success
    presence = two.body
    lab = presence.environment.workspace("/main/lab")
    presence.enter()
    presence.join(lab)
    presence.focused.begin(lab, made.value, "ns")
    assert two.beliefs == ["ns::count(5)"]
    assert [w.path for w in two.body.workspaces.joined()] == ["/main", "/main/lab"]


@among_artifacts
async def test_an_agent_enters_its_home_with_the_first_action_and_prints(one, two, clock):
    assert one.log == []
    one.do("println")
    assert one.log[0].endswith('main,"/main")')
    one.body.enter()
    assert len(one.log) == 2
    assert one.do("println", "X: ", 3, atom("a"), Var("Y")).success
    assert one.do("print", "x").success
    assert one.lines == ["", "X: 3aY<no-value>", "x"]


@among_artifacts
async def test_an_agent_that_has_ended_waits_for_no_artifact(one, two, clock):
    presence = two.body
    presence.enter()
    told: list[object] = []
    presence.focus_when_available(presence.workspaces.home, "c", lambda *about: told.append(about))
    two.body.close()
    one.make("c", "Counter", 5)
    assert (two.beliefs, presence.focused.in_order()) == ([], ())
    assert len(told) == 1


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
async def test_actions_may_be_directed_to_the_session(one, two, clock):
    one.do("createWorkspace", "lab")
    session = one.ask("lookupArtifact", "session_one")
    assert one.do("joinWorkspace", "lab", artifact_id=session).success
    body = one.ask("lookupArtifact", "/main/lab/body_one")
    one.make("c", "Counter")
    assert one.do("focusWhenAvailable", "c", artifact_id=body).success
    assert one.beliefs == ["count(0)"]
    assert one.do("joinWorkspace", "/main", aid=session).success


@among_artifacts
async def test_bodies_obey_their_owners_and_do_only_what_a_body_does(one, two, clock):
    c = one.make("c", "Counter")
    two.do("println")
    body = one.ask("lookupArtifact", "body_two")
    assert reason_of(one.do("focus", c, artifact_id=body)) == 'security_exception("one","body_two")'
    session = one.ask("lookupArtifact", "session_two")
    assert reason_of(one.do("quitFromEnvironment", artifact_id=session)) == (
        'security_exception("one","session_two")'
    )
    assert two.beliefs == []
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
        act = one.begin(action(name, *arguments))
        await clock.sleep(0.1)
        failure = one.completions[act]
        assert reason_of(failure) == f'not_supported("{name}/{len(arguments)}")'
        assert len(message_of(failure)) > 20


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
async def test_patterns_let_pass_what_fits_and_invalid_ones_are_wrong(one, two, clock):
    c = one.make("c", "Counter", 5)
    assert one.do("focus", c, structure("count", Var())).success
    one.do("inc")
    assert one.beliefs == ["count(6)"]
    assert "signal tick" not in one.log
    one.do("stopFocus", c)
    assert one.beliefs == []
    for wrong in (3, "count", NIL, [3]):
        failure = one.do("focus", c, wrong)
        assert "expected a filter: a pattern such as count(_)" in message_of(failure)
        assert reason_of(failure).startswith("wrong_op_arguments(")
    assert one.beliefs == []


@among_artifacts
async def test_an_action_that_waits_too_long_fails(one, two, clock):
    waiting = one.begin(action("focusWhenAvailable", "late", timeout=500))
    in_time = one.begin(action("focusWhenAvailable", "soon", timeout=500))
    two.make("soon", "Counter")
    assert one.completions[in_time].success
    await clock.sleep(0.6)
    assert reason_of(one.completions[waiting]) == 'operation_timeout("focusWhenAvailable/1",500)'
    assert message_of(one.completions[waiting]) == "focusWhenAvailable/1 did not end within 500 ms"
    two.make("late", "Counter", 7)
    assert one.beliefs == ["count(0)"]
    assert one.activity.pending == 0


@among_artifacts
async def test_two_agents_cannot_make_one_artifact_and_invalid_times_are_refused(one, two, clock):
    one.do("println"), two.do("println")
    assert one.do("makeArtifact", "c", "Counter").success
    for name in ("c", "workspace", "body_one"):
        assert reason_of(two.do("makeArtifact", name, "Counter")) == (
            f'makeArtifactFailure("artifact_already_present","{name}")'
        )
    for wrong in (atom("soon"), -1, Var("X")):
        failure = one.do("println", timeout=wrong)
        assert "timeout: expected a number of milliseconds" in message_of(failure)
        assert "unknown_annotation" in str(reason_of(failure))
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
