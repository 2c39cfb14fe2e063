"""Operations on behalf of an agent: outputs, failures, order of news, dropping and suspending."""

from body_lab import action, among_artifacts, detail_of, message_of, reason_of

from jacaros.agents.terms.values import Var, functor


@among_artifacts
async def test_outputs_are_given_to_the_variables(one, two, clock):
    one.make("c", "Counter", 4)
    count = Var("N")
    completion = one.do("read", count)
    assert completion.outputs == ((count, 4.0),)


@among_artifacts
async def test_the_mind_perceives_the_changes_before_the_end_of_the_action(one, two, clock):
    one.do("focus", one.make("c", "Counter"))
    one.log.clear()
    one.do("inc")
    assert one.log == ["signal tick", "remove count(0)", "add count(1)", "done"]


@among_artifacts
async def test_a_failed_operation_gives_message_and_reason(one, two, clock):
    one.make("c", "Counter")
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
async def test_a_waiting_operation_ends_when_its_guard_becomes_true(one, two, clock):
    one.make("c", "Counter")
    take = one.begin(action("take"))
    assert one.body.pending == (take,)
    assert one.activity.pending == 1
    two.do("inc", 1)
    assert one.completions[take].success
    assert one.activity.pending == 0


@among_artifacts
async def test_a_dropped_action_is_neither_reported_nor_executed(one, two, clock):
    one.make("c", "Counter")
    take = one.begin(action("take"))
    one.body.cancel_act(take)
    one.body.cancel_act(take)
    two.do("inc", 1)
    assert take not in one.completions
    assert two.ask("read") == 1.0
    assert one.activity.pending == 0


@among_artifacts
async def test_a_suspended_action_pauses_a_pausable_operation(one, two, clock):
    one.make("c", "Counter")
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
