"""What observers see: focus, coalescing, signals and changes of one step, order, signals to one agent."""

import pytest

from jacaros.artifacts import Artifact, Structure, operation


class Ticker(Artifact):
    def init(self, start: int = 0):
        self.define_property("count", start)

    @operation
    def inc(self):
        self.update_property("count", self.value("count") + 1)

    @operation(name="tickInc")
    def tick_inc(self):
        self.inc()
        self.signal("tick", self.value("count"))

    @operation(name="sigFirst")
    def signal_first(self):
        self.signal("early", self.value("count"))
        self.inc()

    @operation
    def between(self):
        self.inc()
        self.signal("one")
        self.inc()
        self.inc()
        self.signal("two")
        self.inc()

    @operation
    def halfway(self):
        self.inc()
        self.commit()
        self.inc()
        self.fail("too late")

    @operation
    def tell_and_fail(self):
        self.inc()
        self.signal("done")
        self.inc()
        self.fail("after the signal")

    @operation
    def shout(self):
        self.signal("Shout")


pytestmark = pytest.mark.makes(it=Ticker)


async def test_focusing_an_artifact_without_properties_is_silent(stage):
    assert stage.watch(await stage.make(Artifact)).notes == []


async def test_a_signal_and_the_changes_before_it_are_one_publication_signal_first(stage, it, watcher):
    stage.call(it, "tickInc")
    assert watcher.take() == ["~tick(1) -count(0) +count(1)"]
    stage.call(it, "sigFirst")
    assert watcher.take() == ["~early(1)", "-count(1) +count(2)"]
    stage.call(it, "between")
    assert watcher.take() == ["~one -count(2) +count(3)", "~two -count(3) +count(5)", "-count(5) +count(6)"]


async def test_what_was_committed_or_signalled_stays_when_the_step_fails(stage, it, watcher):
    assert not stage.call(it, "halfway").ok
    assert watcher.take() == ["-count(0) +count(1)"]
    assert not stage.call(it, "tell_and_fail").ok
    assert watcher.take() == ["~done -count(1) +count(2)"]
    stage.call(it, "inc")
    assert watcher.take() == ["-count(2) +count(3)"]


async def test_signal_names_begin_with_a_lower_case_letter(stage, it):
    call = stage.call(it, "shout")
    assert call.reason == Structure("operation_error", ("shout/0",))
    assert "lower-case" in call.outcome.message


@pytest.mark.expects_defects
async def test_a_broken_observer_is_reported_and_the_others_are_notified(stage, it):
    class Broken:
        agent = "broken"

        def observe(self, observation):
            raise ValueError("broken observer")

    stage.main.focus(it, Broken())
    watcher = stage.watch(it)
    assert stage.call(it, "inc").ok
    assert watcher.notes[-1] == "-count(0) +count(1)"
    assert [str(error) for error in stage.defects] == ["broken observer"] * 2
    stage.main.dispose_artifact(it)


async def test_an_observer_may_stop_while_it_is_notified(stage, it):
    class Once:
        agent = "once"
        seen = 0

        def observe(self, observation):
            self.seen += 1
            if observation.changed:
                stage.main.stop_focus(it, self)

    once = Once()
    stage.main.focus(it, once)
    watcher = stage.watch(it)
    stage.call(it, "inc")
    stage.call(it, "inc")
    assert once.seen == 3, "focus, one change, and the end of the focus"
    assert watcher.notes[-1] == "-count(1) +count(2)"
