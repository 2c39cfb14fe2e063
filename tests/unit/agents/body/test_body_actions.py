"""What agents do with workspaces and artifacts as such."""

import re

from body_lab import action, among_artifacts, detail_of, message_of, reason_of

from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import Reference, Var, atom, list_items


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
async def test_artifacts_are_found_by_type_and_listed(one, two, clock):
    made = one.make("c", "Counter")
    assert one.ask("lookupArtifactByType", "Counter") is made
    assert reason_of(one.do("lookupArtifactByType", "Lamp", Var())) == 'artifact_not_available("Lamp")'
    names = [text(name) for name in list_items(one.ask("getCurrentArtifacts"))]
    default = ['"blackboard"', '"console"', '"manrepo"', '"system"', '"workspace"']
    assert names == [*default, '"c"', '"session_one"', '"body_one"']


@among_artifacts
async def test_a_missing_artifact_is_reported_with_a_spelling_suggestion(one, two, clock):
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
async def test_focus_when_available_waits_for_the_artifact(one, two, clock):
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
async def test_waiting_for_an_artifact_can_be_cancelled(one, two, clock):
    waiting = one.begin(action("focusWhenAvailable", "c"))
    one.body.suspend_act(waiting)
    one.body.resume_act(waiting)
    one.body.cancel_act(waiting)
    two.make("c", "Counter", 2)
    assert one.beliefs == []
    assert waiting not in one.completions
    assert one.activity.pending == 0


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
async def test_a_path_names_an_artifact_of_another_workspace(one, two, clock):
    one.do("createWorkspace", "lab")
    made = one.make("lab/c", "Counter", 5)
    assert one.ask("lookupArtifact", "/main/lab/c") is made
    assert one.ask("lookupArtifact", "../main/lab/c") is made
    assert not one.do("lookupArtifact", "c", Var()).success


@among_artifacts
async def test_an_agent_can_print_through_the_console(one, two, clock):
    assert one.do("println", "X: ", 3, atom("a"), Var("Y")).success
    assert one.do("print", "x").success
    assert one.lines == ["X: 3aY<no-value>", "x"]


@among_artifacts
async def test_an_agent_enters_its_home_with_the_first_action(one, two, clock):
    assert one.log == []
    one.do("println")
    assert one.log[0].endswith('main,"/main")')
    one.body.enter()
    assert len(one.log) == 2


@among_artifacts
async def test_a_project_can_let_agents_join_and_focus(one, two, clock):
    one.do("createWorkspace", "lab")
    made = one.make("lab/c", "Counter", 5)
    presence = two.body
    lab = presence.environment.workspace("/main/lab")
    presence.enter()
    presence.join(lab)
    presence.focused.begin(lab, made.value, "ns")
    assert two.beliefs == ["ns::count(5)"]
    assert [w.path for w in two.body.workspaces.joined()] == ["/main", "/main/lab"]


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
