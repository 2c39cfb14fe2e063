"""Random programs of agents, sessions and artifacts, each step compared with a model (`environment_model`)."""

import asyncio
import random

import pytest
from environment_model import NAMES, OBSERVERS, Model

import jacaros
from jacaros import GoalFailed, Mas
from jacaros.artifacts import Artifact, OperationFailed, operation

PLANS = """
+!make(N, Script) <- makeArtifact(N, "Puppet", [Script]).
+!focus(N) <- lookupArtifact(N, Id); focus(Id).
+!stop(N) <- lookupArtifact(N, Id); stopFocus(Id).
+!dispose(N) <- lookupArtifact(N, Id); disposeArtifact(Id).
"""
for _kind in ("quick", "guarded", "slow"):
    PLANS += f"+!{_kind}(N, S) <- {_kind}(S)[artifact_name(N)].\n"
    PLANS += f"+!{_kind}(N, S, T) <- {_kind}(S)[artifact_name(N), timeout(T)].\n"
for _name in (*NAMES, "tick", "tock"):
    _sign = "~" if _name.startswith("t") else "+"
    PLANS += f'+{_name}(V)[artifact_name(A)] <- .print("{_sign} ", A, " {_name} ", V).\n'
    PLANS += f'-{_name}(V)[artifact_name(A)] <- .print("- ", A, " {_name} ", V).\n'


class Puppet(Artifact):
    """Runs a script."""

    def init(self, script: list[list[object]]) -> None:
        self.do(script)

    def do(self, script):
        for step in script:
            self.do_step(*step)

    def do_step(self, kind, *rest):
        if kind == "def":
            self.define_property(*rest)
        elif kind == "update" and self.has_property(rest[0]):
            self.update_property(*rest)
        elif kind == "remove" and self.has_property(rest[0]):
            self.remove_property(rest[0])
        elif kind == "signal":
            self.signal(*rest)
        elif kind == "signal_to":
            self.signal_to(*rest)
        elif kind == "fail":
            self.fail("no", "refused", *rest)
        elif kind == "raise":
            raise KeyError(*rest)
        elif kind == "dispose" and self.id in self.workspace.artifacts():
            self.workspace.dispose_artifact(self.id)

    @operation
    def quick(self, script):
        self.do(script)

    @operation(guard="ready")
    def guarded(self, script):
        self.do(script)

    def ready(self):
        return self.has_property("go")

    @operation
    async def slow(self, script):
        for kind, *rest in script:
            if kind == "sleep":
                await self.sleep(*rest)
            elif kind == "until":
                await self.until(self.ready)
            else:
                self.do_step(kind, *rest)


class Program:
    """A random program. The outcome of each step is compared with the model."""

    def __init__(self, seed):
        self.random = random.Random(seed)
        self.model, self.steps, self.value = Model(), [], 0
        self.noticed = {each: [] for each in OBSERVERS}
        self.agents, self.sessions, self.under_way = {}, {}, {}

    async def run(self, length):
        async with Mas(seed=1, on_print=self.printed, on_log=lambda line, level: None) as mas:
            self.mas, self.workspace = mas, mas.environment.workspace("/main")
            mas.add_artifact_types(Puppet)
            for name in OBSERVERS:
                if name.startswith("s"):
                    self.observe(name, mas.session(name))
                else:
                    self.agents[name] = mas.add_agent(name, PLANS)
            for number in range(length):
                await self.step(number)
                for _ in range(25):
                    await asyncio.sleep(0)
                self.compare()

    def printed(self, agent, line):
        sign, artifact, name, value = line.split()
        self.noticed[agent].append((sign, artifact, name, int(value)))

    def observe(self, name, session):
        self.sessions[name], noticed = session, self.noticed[name]

        def changed(change):
            for sign, values in (("-", change.before), ("+", change.now)):
                if values:
                    noticed.append((sign, change.artifact.name, change.name, values[0]))

        session.on_change(changed)
        session.on_signal(lambda s: noticed.append(("~", s.artifact.name, s.name, s.arguments[0])))

    # ---- steps

    async def step(self, number):
        choice = self.random.random()
        observer, name = self.random.choice(OBSERVERS), self.random.choice("xy")
        if choice < 0.12:
            script = self.script("init")
            await self.do(observer, "make", name, script, wanted=self.model.make(name, script))
        elif choice < 0.27:
            await self.do(observer, "focus", name, wanted=self.model.focus(observer, name))
        elif choice < 0.33:
            await self.do(observer, "stop", name, wanted=self.model.stop(observer, name))
        elif choice < 0.36:
            await self.do(observer, "dispose", name, wanted=self.model.dispose(name))
        elif choice < 0.5:
            seconds = self.random.random() * 3
            self.steps.append(("advance", seconds))
            self.model.advance(seconds)
            await self.mas.sleep(seconds)
        elif choice < 0.58 and self.under_way:
            cancelled = self.random.choice(list(self.under_way))
            self.steps.append(("cancel", cancelled))
            self.model.cancel(cancelled)
            handle = self.under_way.pop(cancelled)
            handle.drop() if hasattr(handle, "drop") else handle.cancel()
        else:
            self.begin(number, observer, name)

    def begin(self, number, observer, name):
        kind = self.random.choice(("quick", "guarded", "guarded", "slow", "slow"))
        script = self.script(kind)
        milliseconds = self.random.choice((None, None, self.random.randint(2000, 3000)))
        timeout = None if milliseconds is None else milliseconds / 1000
        self.steps.append((number, observer, kind, name, script, timeout))
        self.model.begin(number, name, kind, script, timeout)
        if observer in self.agents:
            more = [] if timeout is None else [milliseconds]
            self.under_way[number] = self.agents[observer].achieve(goal(kind, name, script, *more))
        else:
            self.begin_in(self.sessions[observer], number, kind, name, script, timeout)

    def begin_in(self, session, number, kind, name, script, timeout):
        outcome = self.model.outcomes.get(number)
        try:
            self.under_way[number] = session.begin(kind, script, artifact=name, timeout=timeout)
        except OperationFailed as failure:
            failed = reason(failure)
        else:
            return
        assert failed == outcome, self.told()

    async def do(self, observer, action, name, *script, wanted):
        self.steps.append((observer, action, name, *script))
        try:
            if observer in self.agents:
                await self.agents[observer].achieve(goal(action, name, *script))
            else:
                await self.use(self.sessions[observer], action, name, *script)
            outcome = "ok"
        except (GoalFailed, OperationFailed) as failure:
            outcome = reason(failure)
        assert outcome == wanted, self.told()

    async def use(self, session, action, name, *script):
        if action == "make":
            await session.make_artifact(name, Puppet, script)
        elif action == "focus":
            session.focus(name)
        elif action == "stop":
            session.stop_focus(name)
        else:
            await session.act("disposeArtifact", session.lookup(name))

    def script(self, kind):
        return [self.scripted(kind) for _ in range(self.random.randint(0, 5))]

    def scripted(self, kind):
        self.value += 1
        choice, name = self.random.random(), self.random.choice(NAMES)
        value = self.random.choice((self.value, 1))
        for limit, step in (
            (0.3, ["def", name, value]),
            (0.5, ["update", name, value]),
            (0.68, ["remove", name]),
            (0.78, ["signal", "tick", value]),
            (0.83, ["signal_to", self.random.choice(OBSERVERS), "tock", value]),
            (0.86, ["fail", value]),
            (0.89, ["raise", value]),
        ):
            if choice < limit:
                return step
        if kind == "init":
            return ["def", name, value]
        if choice < 0.9:
            return ["dispose"]
        if kind != "slow":
            return ["update", name, value]
        # No two ends at one time: their order would be a matter of taste.
        return ["until", "go"] if choice < 0.93 else ["sleep", 0.5 + self.random.random()]

    # ---- outcomes

    def compare(self):
        for name in OBSERVERS:
            assert self.noticed[name] == self.model.events[name], self.told()
            self.noticed[name].clear()
            self.model.events[name].clear()
            self.compare_mind(name)
        for number, handle in tuple(self.under_way.items()):
            outcome = outcome_of(handle)
            assert outcome == self.model.outcomes.get(number), self.told()
            if outcome is not None:
                del self.under_way[number]
        made = [each for each in self.workspace.artifacts() if each.creator]
        assert sorted(each.name for each in made) == sorted(self.model.things), self.told()
        for each in made:
            self.compare_artifact(each, self.model.things[each.name])

    def compare_mind(self, name):
        wanted = sorted(self.model.beliefs[name])
        if name in self.agents:
            ask = self.agents[name].answers
            beliefs = [(each, a) for each in NAMES for a in ask(f"{each}(V)[artifact_name(A)]")]
            assert sorted((a["A"], each, a["V"]) for each, a in beliefs) == sorted(wanted), self.told()
            focused = [a["A"] for a in ask("focusing(_, A, _, _, _, _)")]
        else:
            session = self.sessions[name]
            properties = [each for name in NAMES for each in session.properties(name)]
            assert sorted((p.artifact.name, p.name, *p.values) for p in properties) == wanted, self.told()
            focused = [each.name for each in session.focused]
        assert sorted(focused) == self.model.focused(name), self.told()

    def compare_artifact(self, artifact, thing):
        observers = [each.agent for each in self.workspace.observers(artifact)]
        assert observers == thing.observers, self.told()
        shown = [(each.name, *each.values) for each in self.workspace.properties(artifact)]
        assert shown == [thing.published[key] for key in sorted(thing.published)], self.told()
        assert len(self.workspace.pending(artifact)) == self.model.under_way(thing), self.told()

    def told(self):
        return "\n".join(map(str, self.steps))


def goal(name, artifact, *arguments):
    return f"{name}({', '.join([artifact, *map(written, arguments)])})"


def written(value):
    if isinstance(value, list):
        return f"[{', '.join(map(written, value))}]"
    return f'"{value}"' if isinstance(value, str) else str(value)


def reason(failure):
    found = failure.reason("env_failure_reason") if isinstance(failure, GoalFailed) else failure.reason
    name = getattr(found, "functor", found)
    return "gone" if name == "artifact_not_available" else name


def outcome_of(handle):
    if hasattr(handle, "drop"):
        if not handle.failed:
            return "ok" if handle.achieved else None
        found = next(term for term in handle.reasons if term[0].name == "env_failure_reason")[1]
        name = found[0].name if isinstance(found, tuple) else found.name
        return "gone" if name == "artifact_not_available" else name
    if not handle.done:
        return None
    return "ok" if handle.outcome.ok else reason(OperationFailed("", handle.outcome.reason))


@pytest.mark.parametrize("seed", range(8))
def test_percepts_agree_with_the_model(seed):
    for each in range(3):
        jacaros.run(Program(100 * seed + each).run(40), clock="fast")
