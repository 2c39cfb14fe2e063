"""The history of a run: records, listeners, beginning and end."""

import pytest
from observed_runs import of, records_of

import jacaros
from jacaros import Mas
from jacaros.look.records import records
from jacaros.runtime.mas.history.history import History


def test_agents_created_later_are_observed():
    records = records_of(
        {"ann": "p."}, during=lambda mas: mas.add_agent("bob", "!go. +!go <- .wait(1000); .print(x).")
    )
    assert [(t, data["agent"], data["state"]) for t, event, data in records if event == "goal"] == [
        (5.0, "bob", "pursued"),
        (6.0, "bob", "achieved"),
    ]


def test_a_goal_that_is_open_when_the_run_ends_is_dropped():
    records = records_of({"ann": "!go. +!go <- !on. +!on <- .wait(3000); .stopMAS(0, 4)."})
    assert [
        (t, data["goal"]) for t, event, data in records if event == "goal" and data["state"] == "dropped"
    ] == [
        (3.0, "!go"),
        (3.0, "!on"),
    ]
    assert of(records, "ended") == [{"code": 4}]


def observed(act):
    """Run *act* with the history of a system on which nothing happens."""

    async def main():
        async with Mas(on_log=lambda *line: None) as mas:
            act(History(mas.system, kept=3))

    jacaros.run(main(), clock="fast")


def test_old_records_are_dropped_except_those_that_describe_present_agents():
    def act(history):
        history.record(records.AgentRecord("ann", "began"))
        history.record(records.AgentRecord("bob", "began"))
        for number in range(3):
            history.record(records.LogRecord("info", str(number)))
        assert [data for _, _, data in history.all()][:2] == [
            {"agent": "ann", "state": "began"},
            {"agent": "bob", "state": "began"},
        ]
        assert [data.get("text") for _, _, data in history.events] == ["0", "1", "2"]
        history.record(records.AgentRecord("ann", "ended"))
        for number in range(3):
            history.record(records.LogRecord("info", str(number)))
        assert [data.get("agent") for _, _, data in history.all()] == ["bob", None, None, None]

    observed(act)


def test_nothing_of_an_ended_agent_lasts():
    def act(history):
        for name in ("ann", "bob"):
            history.record(records.AgentRecord(name, "began"))
            history.record(records.BeliefRecord(name, "+", "kind"))
            history.record(records.GoalRecord(name, "!go", "pursued", 1))
            history.record(records.GoalRecord(name, "!go", "suspended", 1))
        history.record(records.AgentRecord("ann", "ended"))
        for number in range(3):
            history.record(records.LogRecord("info", str(number)))
        assert [(event, data.get("state")) for _, event, data in history.all()[:-3]] == [
            ("agent", "began"),
            ("belief", None),
            ("goal", "pursued"),
            ("goal", "suspended"),
        ]
        assert all(data["agent"] == "bob" for _, _, data in history.all()[:-3])

    observed(act)


def test_a_listener_hears_until_it_ends():
    def act(history):
        heard = []
        end = history.listen(lambda t, event, data: heard.append(data["text"]))
        history.record(records.LogRecord("info", "one"))
        end()
        end()
        history.record(records.LogRecord("info", "two"))
        assert heard == ["one"]

    observed(act)


@pytest.mark.parametrize("starts", [1, 2])
def test_the_last_stop_ends_the_observation(starts):
    async def main():
        async with Mas(on_log=lambda *line: None) as mas:
            history = mas.system.history()
            assert mas.system.history() is history
            for _ in range(starts):
                history.start()
            history.stop()
            mas.add_agent("ann", "!go. +!go.")
            await mas.system.clock.sleep(1.0)
            assert ("goal" in {each.event for each in history.events}) == (starts == 2)
            history.stop()

    jacaros.run(main(), clock="fast")


def test_an_artifact_that_was_disposed_is_not_kept():
    def act(history):
        for state in ("made", "disposed"):
            history.record(records.ArtifactRecord("/main/lamp", state=state))
        history.record(records.ArtifactRecord("/main/door", state="made"))
        for number in range(3):
            history.record(records.LogRecord("info", str(number)))
        assert [data.get("artifact") for _, _, data in history.all()] == ["/main/door", None, None, None]

    observed(act)
