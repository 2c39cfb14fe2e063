"""Which artifact gets an action."""

from body_lab import Robot, among_artifacts, detail_of, message_of, reason_of

from jacaros.agents.terms.values import Reference, Var, atom


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
