"""The host of a mind in its run."""

from jacaros.agents.mind.state.act import Act, Completion, Percept, SpeechAct
from jacaros.agents.mind.state.budget import Options
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import Term, atom, functor
from jacaros.artifacts.presence.presence import Activity
from jacaros.runtime.clock import VirtualClock, run
from jacaros.runtime.mas.agents.host import AgentHost
from jacaros.runtime.mas.scheduler import Scheduler


class Mind:
    """Takes notes."""

    stopped = False
    options = Options()

    def __init__(self) -> None:
        self.log: list[str] = []

    def start(self) -> None:
        self.log.append("start")

    def post_goal(self, goal: Term) -> None:
        self.log.append(f"goal {text(goal)}")

    def run(self, fuel: int) -> bool:
        self.log.append("run")
        return False

    def receive(self, message: SpeechAct) -> None:
        self.log.append(f"receive {text(message.content)}")

    def perceive(self, percepts: list[Percept]) -> None:
        self.log.append("perceive")

    def complete(self, act_id: int, completion: Completion) -> None:
        why = " ".join(map(text, completion.annotations))
        self.log.append(f"complete {act_id} {completion.success} {why}")


class Body:
    """Takes notes."""

    def __init__(self, log: list[str]) -> None:

        self.act = lambda act: log.append(f"act {act.id}")
        self.cancel_act = lambda act_id: log.append(f"cancel {act_id}")
        self.suspend_act = lambda act_id: log.append(f"suspend {act_id}")
        self.resume_act = lambda act_id: log.append(f"resume {act_id}")
        self.close = lambda: log.append("close")


class FakeRun:
    """A run with one agent."""

    def __init__(self) -> None:
        self.clock = VirtualClock()
        self.scheduler = Scheduler(self.clock)
        self.activity = Activity()
        self.console = self
        self.lines: list[str] = []

    def print(self, agent: str, text: str) -> None:
        self.lines.append(f"[{agent}] {text}")

    def log(self, text: str, level: str = "info") -> None:
        self.lines.append(f"{level}: {text}")

    def deliver(self, message: SpeechAct) -> bool:
        return message.receiver == "ann"

    def stop_system(self, delay: float, exit_code: int) -> None:
        self.lines.append(f"stop {delay} {exit_code}")


def host_and_mind() -> tuple[AgentHost, Mind, FakeRun]:
    run_ = FakeRun()
    host, mind = AgentHost("ann", run_, "1"), Mind()
    host.set_mind(mind)
    return host, mind, run_


def act() -> Act:
    return Act(1, functor("move", 1), (3.0,), (), 1)


def test_an_action_without_environment_fails_immediately() -> None:
    host, mind, _ = host_and_mind()
    host.act(act())
    host.cancel_act(1)
    host.suspend_act(1)
    host.resume_act(1)
    (line,) = mind.log
    assert line.startswith("complete 1 False error_msg(")
    assert line.endswith("env_failure_reason(no_environment)")


def test_the_body_is_made_for_the_first_action() -> None:
    host, mind, _ = host_and_mind()
    made: list[Body] = []

    def make_body() -> Body:
        made.append(Body(mind.log))
        return made[-1]

    host.make_body = make_body
    host.act(act())
    host.act(act())
    host.suspend_act(1)
    host.resume_act(1)
    host.cancel_act(1)
    host.end()
    assert len(made) == 1
    assert mind.log == ["act 1", "act 1", "suspend 1", "resume 1", "cancel 1", "close"]


def test_a_halted_agent_neither_runs_nor_prints_nor_receives() -> None:
    host, mind, run_ = host_and_mind()
    host.halt()
    host.end()
    assert not host.run(10)
    host.print("x")
    host.receive(SpeechAct("tell", "bob", "ann", atom("x"), "mid1"))
    assert mind.stopped
    assert mind.log == run_.lines == []


def test_a_ready_agent_gets_a_turn() -> None:
    host, mind, run_ = host_and_mind()

    async def main() -> None:
        host.ready()
        await run_.clock.sleep(1)

    run(main, run_.clock)
    assert mind.log == ["run"]
    assert host.now() == run_.clock.now()


def test_requests_of_the_mind_go_to_the_run() -> None:
    host, mind, run_ = host_and_mind()
    host.print("hello")
    host.log("warning", "beware")
    host.stop_system(1.0, 2)
    assert run_.lines == ["[ann] hello", "warning: [ann] warning: beware", "stop 1.0 2"]
    assert host.send(SpeechAct("tell", "ann", "ann", atom("x"), "mid1"))
    assert host.system is run_
    host.receive(SpeechAct("tell", "bob", "ann", atom("x"), "mid1"))
    assert mind.log == ["receive x"]
