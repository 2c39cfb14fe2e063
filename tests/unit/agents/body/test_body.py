"""What agents do through their body: operations, artifacts, workspaces, and the artifacts that every workspace has."""

import re

from body_lab import Robot, action, among_artifacts, detail_of, message_of, reason_of

from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import NIL, Reference, Term, Var, atom, functor, list_items, structure


@among_artifacts
async def test_outputs_are_given_to_the_variables(one, two, clock):
    one.make("c", "Counter", 4)
    count = Var("N")
    completion = one.do("read", count)
    assert completion.outputs == ((count, 4.0),)


@among_artifacts
async def test_outputs_changes_and_failures_of_operations_reach_the_mind(one, two, clock):
    one.do("focus", one.make("c", "Counter"))
    one.log.clear()
    one.do("inc")
    assert one.log == ["signal tick", "remove count(0)", "add count(1)", "done"]
    failure = one.do("refuse")
    assert message_of(failure) == "no"
    assert reason_of(failure) == "refused(3)"
    assert failure.annotations[1][0] is functor("env_failure_reason", 1)


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
async def test_a_disposed_artifact_fails_the_actions_that_wait_for_it(one, two, clock):
    c = one.make("c", "Counter")
    take = one.begin(action("take"))
    two.do("disposeArtifact", c)
    assert reason_of(one.completions[take]) == 'artifact_disposed("c")'


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
async def test_own_artifacts_come_first_the_oldest_of_them(one, two, clock):
    two.make("theirs", "Counter", 0)
    first, second = one.make("first", "Counter", 1), one.make("second", "Counter", 2)
    one.do("focus", second)
    assert count(one) == 1.0
    one.do("disposeArtifact", first)
    assert count(one) == 2.0


@among_artifacts
async def test_focused_artifacts_come_before_any_other(one, two, clock):
    one.make("a", "Counter", 1)
    b, c = one.make("b", "Counter", 2), one.make("c", "Counter", 3)
    assert count(two) == 1.0
    two.do("focus", c)
    two.do("focus", b)
    assert count(two) == 3.0


@among_artifacts
async def test_an_annotation_directs_the_action(one, two, clock):
    one.make("a", "Counter", 1)
    b = one.make("b", "Counter", 2)
    assert count(one, artifact_id=b) == count(one, aid=b) == 2.0
    assert count(one, artifact_name="b") == count(one, art=atom("b")) == 2.0
    assert count(one, artifact_id="b") == 2.0
    assert count(one, artifact_name="b", wsp="main") == count(one, art="b", wsp="/main") == 2.0
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
async def test_the_current_workspace_comes_before_home_and_others(one, two, clock):
    for number, name in enumerate(("lab", "attic"), start=2):
        one.do("createWorkspace", f"/main/{name}")
        one.do("joinWorkspace", f"/main/{name}")
        one.make("c", "Counter", number)
    one.make("t", "Total")
    assert count(one) == 3.0
    one.do("joinWorkspace", "/main")
    assert count(one) == 2.0
    two.make("c", "Counter", 1)
    assert count(one) == 1.0
    assert "the workspaces /main, /main/lab, /main/attic" in message_of(one.do("jump"))


@among_artifacts
async def test_a_namespace_means_the_artifacts_focused_in_it(one, two, clock):
    one.make("a", "Counter", 1)
    b = one.make("b", "Counter", 2)
    assert one.do("ns::focus", b).success
    assert one.beliefs == ["ns::count(2)"]
    assert one.ask("ns::read") == 2.0
    assert count(one) == 1.0
    assert one.ask("other::read") == 1.0
    assert one.do("focus", b).success
    assert one.do("ns::stopFocus", b).success
    one.do("inc", artifact_id=b)
    assert one.beliefs == ["count(3)"]


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
async def test_the_id_of_an_artifact_takes_precedence_over_other_annotations(one, two, clock):
    one.make("a", "Counter", 1)
    b = one.make("b", "Counter", 2)
    assert count(one, artifact_id=b, artifact_name="a", wsp="nowhere") == 2.0


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
    assert "expected an artifact" in message_of(one.do("read", Var(), artifact_id=Reference(object())))


def without_ids(reason: str | None) -> str:
    """A reason in which ids do not matter."""
    assert reason is not None
    return re.sub(r"cobj_\d+", "ID", reason)


@among_artifacts
async def test_an_artifact_is_made_with_or_without_parameters_and_id(one, two, clock):
    assert one.do("makeArtifact", "a", "Counter").success
    assert one.do("makeArtifact", atom("b"), atom("'Counter'"), [7]).success
    made = one.ask("makeArtifact", "c", "Counter", [])
    assert isinstance(made, Reference)
    assert one.ask("lookupArtifact", atom("c")) is made
    assert one.ask("makeArtifact", "d", "Counter", []) is one.ask("lookupArtifact", "d")
    assert one.ask("read", artifact_name="b") == 7.0


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
async def test_focusing_shows_the_properties_before_the_action_ends(one, two, clock):
    c = one.make("c", "Counter", 3)
    one.log.clear()
    assert one.do("focus", c).success
    assert one.log[0] == "add count(3)"
    assert one.log[1].startswith("add focusing(cobj_")
    assert one.log[1].endswith('main,"/main")')
    assert ',c,"Counter",' in one.log[1]
    assert one.log[2:] == ["done"]
    assert one.do("focus", c).success
    assert one.log[3:] == ["done"]


@among_artifacts
async def test_an_artifact_is_focused_by_its_id_only(one, two, clock):
    c = one.make("c", "Counter")
    for name in ("focus", "stopFocus"):
        for wrong in (atom("c"), "c", 7, Var("X")):
            assert without_ids(reason_of(one.do(name, wrong))) == f'wrong_op_arguments(ID,"{name}/1")'
    assert "(lookupArtifact gives the id for a name), found c" in message_of(one.do("focus", atom("c")))
    assert (
        without_ids(reason_of(one.do("disposeArtifact", "c"))) == 'wrong_op_arguments(ID,"disposeArtifact/1")'
    )
    linked = one.do("linkArtifacts", "c", "out", c)
    assert without_ids(reason_of(linked)) == 'wrong_op_arguments(ID,"linkArtifacts/3")'


@among_artifacts
async def test_the_end_of_the_focus_takes_the_beliefs_away(one, two, clock):
    c = one.make("c", "Counter")
    assert one.do("stopFocus", c).success
    one.do("focus", c)
    one.do("stopFocus", c)
    one.do("inc", 1)
    assert one.beliefs == []
    assert not any(text(p.literal).startswith("focusing") for p in one.percepts[-1:] if p.kind == "add")
    one.do("focus", c)
    assert one.beliefs == ["count(1)"]


@among_artifacts
async def test_a_disposed_artifact_leaves_no_beliefs_in_any_agent(one, two, clock):
    c = one.make("c", "Counter")
    one.do("focus", c)
    two.do("focus", c)
    assert two.do("disposeArtifact", c).success
    for robot in (one, two):
        assert robot.beliefs == []
        assert [p.kind for p in robot.percepts if text(p.literal).startswith("focusing")] == ["add", "remove"]
    for name in ("focus", "stopFocus", "disposeArtifact"):
        assert reason_of(one.do(name, c)) == 'artifact_not_available("c")'


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
async def test_linked_artifacts_work_together(one, two, clock):
    switch, lamp = one.make("s", "Switch"), one.make("l", "Lamp")
    one.do("focus", lamp)
    assert reason_of(one.do("linkArtifacts", switch, "in", lamp)) == 'unknown_port("in")'
    assert one.do("linkArtifacts", switch, "out", lamp).success
    press = one.begin(action("press"))
    await clock.sleep(0.1)
    assert one.completions[press].success
    assert one.beliefs == ["power(5)"]


@among_artifacts
async def test_workspaces_are_created_joined_and_quit(one, two, clock):
    one.make("c", "Counter", 1)
    assert one.do("createWorkspace", "lab").success
    assert reason_of(one.do("createWorkspace", "lab")) == 'workspace_already_present("/main/lab")'
    lab = one.ask("joinWorkspace", "lab")
    inside = one.make("c", "Counter", 100)
    one.do("focus", inside)
    assert one.log[-3].startswith("add count(100)")
    joined = [text(p.literal) for p in one.percepts if "joinedWsp" in text(p.literal)]
    assert [j.partition(",")[2] for j in joined] == ['main,"/main")', 'lab,"/main/lab")']
    assert one.ask("read") == 100.0
    assert one.do("joinWorkspace", "/main").success
    assert one.ask("read") == 1.0
    assert one.ask("read", wid=lab) == 100.0
    assert one.do("quitWorkspace", lab).success
    assert one.beliefs == []
    assert one.percepts[-1].kind == "remove"
    for directed in (one.do("read", Var(), wid=lab), one.do("read", Var(), artifact_id=inside)):
        assert detail_of(directed) == 'workspace_not_joined("/main/lab")'
        assert reason_of(directed) == "env_failure(action_failed(read,generic_error))"
    made = one.do("makeArtifact", "d", "Counter", wid=lab)
    assert reason_of(made) == "env_failure(action_failed(makeArtifact,generic_error))"
    assert reason_of(one.do("focus", inside)) == 'workspace_not_joined("/main/lab")'
    assert reason_of(one.do("quitWorkspace", lab)) == 'workspace_not_joined("/main/lab")'
    assert reason_of(one.do("joinWorkspace", "attic")) == 'unknown_workspace("/main/attic")'


@among_artifacts
async def test_each_intention_has_a_current_workspace(one, two, clock):
    one.make("c", "Counter", 1)
    one.do("createWorkspace", "lab")
    one.do("joinWorkspace", "lab", intention=1)
    one.do("makeArtifact", "c", "Counter", [100], intention=1)
    one.do("joinWorkspace", "/main", intention=2)
    assert one.ask("read", intention=1) == 100.0
    assert one.ask("read", intention=2) == 1.0
    assert one.ask("read", intention=3) == 1.0


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
