"""Agent architectures of a project: perceiving, acting, sending, looking at mail."""

from pathlib import Path

from extension_lab import write

from jacaros.testing import RunResult, run_project

HEAD = "import asyncio\nfrom jacaros import *\n\n"


def run(
    folder: Path, program: str, python: str, declared: str = "agentArchClass my.Arch", **files: str
) -> RunResult:
    """Run an agent ``bob`` with an architecture of ``my.py``."""
    others = "".join(f" {name.removesuffix('_asl')};" for name in files)
    write(
        folder,
        sys_mas2j=f"MAS sys {{ agents: bob {declared};{others} }}",
        bob_asl=program,
        my=HEAD + python,
        **files,
    )
    return run_project(folder / "sys.mas2j", until_idle=True)


def said(
    folder: Path, program: str, python: str, declared: str = "agentArchClass my.Arch", **files: str
) -> list[str]:
    """Return the output of the agent; nothing may be logged."""
    result = run(folder, program, python, declared, **files)
    assert result.errors == []
    return result.of("bob")


def test_an_architecture_does_actions(tmp_path: Path) -> None:
    python = """
class Arch(AgentArch):
    def act(self, action):
        if action.functor == "add":
            x, y, result = action.arguments
            result.set(x + y)
            return True
        if action.functor == "refuse":
            return False
        if action.functor == "slow":
            return self.slow(*action.arguments)
        if action.functor == "bad":
            raise ValueError("no")
        return super().act(action)

    async def slow(self, seconds, result):
        await asyncio.sleep(seconds)
        result.set(Atom("done"))
"""
    program = """
    !go. !other. !unknown.
    +!go <- add(1, 2, X); .print(X); slow(3, R); .print(R); refuse.
    -!go[error(E)] <- .print(E).
    +!other <- .wait(1000); .print(other).
    +!unknown <- fly. -!unknown[env_failure_reason(R)] <- .print(R).
    """
    assert said(tmp_path, program, python) == ["3", "no_environment", "other", "done", "action_failed"]
    bad = "!bad. +!bad <- bad. -!bad[error(E)] <- .print(E)."
    result = run(tmp_path, bad, python)
    assert result.of("bob") == ["action_failed"]
    assert f"Arch.act: ValueError: no ({tmp_path}/my.py:16)" in result.errors[0]


def test_dropping_the_intention_cancels_the_action(tmp_path: Path) -> None:
    python = """
class Arch(AgentArch):
    async def act(self, action):
        try:
            await asyncio.sleep(100)
        finally:
            self.agent.print("cancelled")
"""
    assert said(tmp_path, "!a. !b. +!a <- go. +!b <- .wait(10); .drop_desire(a).", python) == ["cancelled"]


def test_an_architecture_perceives(tmp_path: Path) -> None:
    python = """
class Arch(AgentArch):
    def init(self, limit):
        self.level, self.limit = 0, limit

    def perceive(self):
        return [f"level({self.level})", Literal("room", (Atom("kitchen"),), (Atom("x"),))]

    def act(self, action):
        self.level = min(self.level + 1, self.limit)
        return True
"""
    program = """
    !go.
    +!go <- up; up; up; up; .findall(L, level(L), Ls); .print(Ls); ?room(R)[source(S), x]; .print(R, S).
    +level(N) <- .print(up, N).
    -level(N) <- .print(gone, N).
    +room(R) <- .print(R).
    """
    printed = said(tmp_path, program, python, "agentArchClass my.Arch(2)")
    assert sorted(printed) == sorted(
        ["[2]", "kitchenpercept", "kitchen", "up0", "gone0", "up1", "gone1", "up2"]
    )


def test_an_idle_agent_is_woken(tmp_path: Path) -> None:
    python = """
class Arch(AgentArch):
    def init(self):
        self.seen = []

    def perceive(self):
        return self.seen

    async def act(self, action):
        asyncio.get_running_loop().create_task(self.later())

    async def later(self):
        await asyncio.sleep(5)
        self.seen = ["light"]
        self.wake()
"""
    program = "!go. +!go <- watch; .wait(9000). +light <- .time(_, _, S); .print(light, S)."
    assert said(tmp_path, program, python) == ["light5"]


def test_messages_pass_through_a_chain(tmp_path: Path) -> None:
    python = """
class Arch(AgentArch):
    def send(self, message):
        self.agent.print("out ", str(message.content))
        return message.performative != "achieve" and super().send(message)

    def check_mail(self, message):
        self.agent.print("in ", message.sender)
        return super().check_mail(message)

class Guard(AgentArch):
    def check_mail(self, message):
        return message.content.functor != "spam" and super().check_mail(message)

    def stop(self):
        self.agent.log("over")
"""
    program = """
    !go.
    +!go <- .send(ann, tell, hello); .send(ann, achieve, nothing).
    -!go[error(E)] <- .print(E).
    +hi <- .print(hi).
    +spam <- .print(spam).
    """
    ann = "+hello <- .send(bob, tell, spam); .send(bob, tell, hi)."
    declared = "agentArchClass my.Arch agentArchClass my.Guard"
    result = run(tmp_path, program, python, declared, ann_asl=ann)
    assert sorted(result.of("bob")) == ["hi", "in ann", "out hello", "out nothing", "receiver_not_found"]
    assert result.errors == ["[bob] info: over"]
