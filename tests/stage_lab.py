"""A test environment on a virtual clock, with recording observers."""

import asyncio

from jacaros.artifacts import Environment, OperationRequest, Out, UnknownArtifactType
from jacaros.runtime.clock import VirtualClock, run


class Watcher:
    """An observer that records observations as short texts: ``~signal +added -removed``."""

    def __init__(self, stage, agent):
        self.stage, self.agent, self.observations = stage, agent, []

    def observe(self, observation):
        self.observations.append(observation)
        self.stage.story.append((self.agent, notes_of(observation)))

    @property
    def notes(self):
        """One text for each publication."""
        return [notes_of(observation) for observation in self.observations]

    def take(self):
        """The notes since the last take."""
        notes = self.notes
        self.observations.clear()
        return notes


def notes_of(observation):
    def shown(name, values):
        return f"{name}({','.join(map(repr, values))})" if values else name

    notes = [f"~{shown(*signal)}" for signal in observation.signals]
    for old, new in observation.changed:
        assert old.key == new.key
        notes += [f"-{shown(old.name, old.values)}", f"+{shown(new.name, new.values)}"]
    notes += [f"+{shown(new.name, new.values)}" for new in observation.added]
    notes += [f"-{shown(old.name, old.values)}" for old in observation.removed]
    return " ".join(notes)


class Call:
    """A call of an operation and its outcome."""

    def __init__(self, stage, label):
        self.stage, self.label, self.outcome, self.execution = stage, label, None, None
        self.ended_at = None
        self._done = asyncio.get_running_loop().create_future()

    def on_done(self, outcome):
        assert self.outcome is None, "an outcome is reported once"
        self.outcome = outcome
        self.ended_at = self.stage.elapsed
        self.stage.story.append((self.label, "ok" if outcome.ok else "failed"))
        self._done.set_result(outcome)

    @property
    def ok(self):
        return self.outcome is not None and self.outcome.ok

    @property
    def reason(self):
        assert not self.outcome.ok
        return self.outcome.reason

    async def wait(self):
        return await self._done


class Stage:
    """What a scene of a test plays on."""

    def __init__(self, clock, resources):
        self.clock, self.lines, self.defects, self.story = clock, [], [], []
        self.types = {}
        self.environment = Environment(
            clock, resources, self.find_type, self.lines.append, self.defects.append
        )
        self.main = self.environment.workspace("/main")

    def find_type(self, name):
        if name not in self.types:
            raise UnknownArtifactType(name, self.types)
        return self.types[name]

    @property
    def elapsed(self):
        return round(self.clock.elapsed, 9)

    async def make(self, artifact_type, *args, name="it", creator="main"):
        return await self.main.make_artifact(name, artifact_type, args, creator)

    def watch(self, artifact_id, agent="main"):
        watcher = Watcher(self, agent)
        self.main.focus(artifact_id, watcher)
        return watcher

    def call(self, artifact_id, operation, *args, agent="main", cause=None, timeout=None):
        call = Call(self, operation)
        request = OperationRequest(artifact_id, operation, args, agent, cause, call.on_done, timeout)
        call.execution = self.main.execute(request)
        return call

    async def ended(self, artifact_id, operation, *args, **options):
        """A call whose outcome has been reported."""
        call = self.call(artifact_id, operation, *args, **options)
        await call.wait()
        return call

    async def output(self, artifact_id, operation, *args, **options):
        """The output, its last argument, of an operation that succeeds."""
        out = Out()
        call = await self.ended(artifact_id, operation, *args, out, **options)
        assert call.ok, call.outcome
        return out.value

    async def after(self, seconds, act, *args):
        """Let time pass, then do something."""
        await self.clock.sleep(seconds)
        act(*args)

    def property(self, artifact_id, name):
        """Values of the first property of that name, as observers know them."""
        return next(p.values for p in self.main.properties(artifact_id) if p.name == name)

    def logged(self, text):
        return any(text in line for line in self.lines)


def play(scene, *, expect_defects=False, **resources):
    """Play a scene, ``async def scene(stage)``; then dispose everything, and nothing of ours may be wrong."""
    clock = VirtualClock()
    stages = []

    async def main():
        stage = Stage(clock, resources)
        stages.append(stage)
        await scene(stage)
        await stage.environment.close()

    run(main, clock)
    assert expect_defects or stages[0].defects == []
    return stages[0]
