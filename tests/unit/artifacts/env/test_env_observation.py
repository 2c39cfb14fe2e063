"""What observers see: focus, coalescing, signals and changes of one step, order, signals to one agent."""

import pytest

from jacaros.artifacts import Artifact, Atom, Structure, operation


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
    def flash(self):
        self.define_property("tmp", 1)
        self.remove_property("tmp")

    @operation
    def mix(self):
        self.define_property("new", [1, 2])
        self.inc()
        self.define_property("gone", 1)
        self.remove_property("gone")

    @operation
    def wipe(self):
        self.remove_property("count")

    @operation
    def whisper(self, agent: str):
        self.inc()
        self.signal_to(agent, "psst", Atom("a"))

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
    def quiet(self):
        pass

    @operation
    def only_whisper(self, agent: str):
        self.signal_to(agent, "psst")

    @operation
    def shout(self):
        self.signal("Shout")

    @operation
    def annotate(self):
        self.define_property("pose", 1, 2, annotations=(Structure("frame", ("map",)),))


pytestmark = pytest.mark.makes(it=Ticker)


async def test_focus_begins_with_all_properties_and_is_idempotent(stage, it):
    watcher = stage.watch(it)
    assert watcher.take() == ["+count(0)"]
    stage.main.focus(it, watcher)
    assert watcher.take() == []
    stage.call(it, "inc")
    assert watcher.take() == ["-count(0) +count(1)"]
    assert stage.main.observers(it) == (watcher,)


async def test_stop_focus_removes_the_properties_and_a_later_focus_shows_the_current_values(stage):
    ticker = await stage.make(Ticker, 10)
    watcher = stage.watch(ticker)
    stage.call(ticker, "inc")
    stage.main.stop_focus(ticker, watcher)
    assert watcher.take() == ["+count(10)", "-count(10) +count(11)", "-count(11)"]
    stage.main.stop_focus(ticker, watcher)
    stage.call(ticker, "inc")
    stage.call(ticker, "tickInc")
    assert watcher.take() == []
    stage.main.focus(ticker, watcher)
    assert watcher.take() == ["+count(13)"], "the signal was for those who focus at that time"
    stage.main.stop_focus(ticker, watcher)
    watcher.take()
    stage.main.dispose_artifact(ticker)
    stage.main.stop_focus(ticker, watcher)
    assert watcher.take() == []


async def test_focusing_an_artifact_without_properties_is_silent(stage):
    assert stage.watch(await stage.make(Artifact)).notes == []


async def test_a_property_added_and_removed_in_one_step_is_not_published(stage, it, watcher):
    stage.call(it, "flash")
    stage.call(it, "quiet")
    assert watcher.take() == []
    stage.call(it, "mix")
    assert watcher.take() == ["-count(0) +count(1) +new([1, 2])"]
    stage.call(it, "wipe")
    assert watcher.take() == ["-count(1)"]


async def test_a_signal_and_the_changes_before_it_are_one_publication_signal_first(stage, it, watcher):
    stage.call(it, "tickInc")
    assert watcher.take() == ["~tick(1) -count(0) +count(1)"]
    stage.call(it, "sigFirst")
    assert watcher.take() == ["~early(1)", "-count(1) +count(2)"]
    stage.call(it, "between")
    assert watcher.take() == ["~one -count(2) +count(3)", "~two -count(3) +count(5)", "-count(5) +count(6)"]


async def test_a_signal_to_one_agent_reaches_it_alone_while_the_changes_reach_all(stage, it):
    alice, bob = stage.watch(it, "alice"), stage.watch(it, "bob")
    stage.call(it, "whisper", "bob")
    assert alice.take() == ["+count(0)", "-count(0) +count(1)"]
    assert bob.take() == ["+count(0)", "~psst(Atom('a')) -count(0) +count(1)"]
    stage.call(it, "whisper", "carol")
    assert alice.take() == bob.take() == ["-count(1) +count(2)"]
    stage.call(it, "only_whisper", "alice")
    assert (alice.take(), bob.take()) == (["~psst"], [])


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


async def test_annotations_of_a_property_are_published(stage, it, watcher):
    stage.call(it, "annotate")
    assert watcher.observations[-1].added[0].annotations == (Structure("frame", ("map",)),)


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
