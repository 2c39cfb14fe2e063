"""What is measured: the programs, their sizes, and what can run them."""

from dataclasses import dataclass
from pathlib import Path
from string import Template

PROGRAMS = Path(__file__).parent / "programs"


@dataclass(frozen=True)
class Workload:
    """A program of one size.

    Attributes:
        name: shown in the table.
        agents: name, program file and number of instances of each.
        n, k: what ``$n`` and ``$k`` stand for in the programs.
        unit: what one of `count` is.
        count: how many units a run does; None to take the reasoning cycles.
        goal: the most that a unit may cost, in empty Python calls with three arguments; None for no goal.
        agentspeak: ``n`` for python-agentspeak, smaller where it would take for ever; None where it lacks something.
        lacks: what it lacks.
        ratio: how many times faster than python-agentspeak a unit has to be; None for no goal.
        jason: whether Jason runs it; what needs our artifacts it cannot.
    """

    name: str
    agents: tuple[tuple[str, str, int], ...]
    n: int
    k: int = 0
    unit: str = "cycle"
    count: int | None = None
    goal: float | None = 50
    agentspeak: int | None = None
    lacks: str = ""
    ratio: float | None = 12
    jason: bool = True

    def write(self, folder: Path, n: int | None = None) -> Path:
        """Write the project into *folder*; its .mas2j file."""
        n = self.n if n is None else n
        for file in {file for _, file, _ in self.agents}:
            source = Template((PROGRAMS / f"{file}.asl").read_text(encoding="utf-8"))
            (folder / f"{file}.asl").write_text(
                source.substitute(n=n, k=self.k, plans=_plans(self.name)), encoding="utf-8"
            )
        if self.name == "percepts":
            (folder / "board.py").write_text(
                (PROGRAMS / "board.py").read_text(encoding="utf-8"), encoding="utf-8"
            )
        lines = [
            f"    {name} {file}.asl{f' #{many}' if many > 1 else ''};" for name, file, many in self.agents
        ]
        project = folder / "bench.mas2j"
        world = "  environment: jacaros.Environment\n" if self.name == "percepts" else ""
        project.write_text(f"MAS bench {{\n{world}  agents:\n" + "\n".join(lines) + "\n}\n", encoding="utf-8")
        return project


def _plans(name: str) -> str:
    if name == "100 plans":
        return "\n".join(f"+!do(kind{i}, X)." for i in range(1, 101))
    if name == "percepts":
        return "\n".join(f"+value{i}(X) : X > 0 <- Y = X + 1." for i in range(10))
    return ""


def single(name: str, file: str, n: int, **rest: object) -> Workload:
    """A workload of one agent."""
    return Workload(name, (("bench", file, 1),), n, **rest)  # type: ignore[arg-type]


WORKLOADS = (
    single("goals", "count", 200_000, goal=25, agentspeak=20_000, ratio=15),
    single("goals, 1M", "count", 1_000_000, goal=25),
    single("while", "while", 100_000, agentspeak=20_000),
    single("for", "for", 200_000, lacks=".range with three arguments"),
    single("facts", "facts", 50_000, agentspeak=10_000),
    single("look-ups in 200 facts", "lookups_again", 20_000, k=200, agentspeak=2_000, ratio=None),
    single("look-ups in 20k facts", "lookups_again", 20_000, k=20_000),
    single("facts and look-ups", "lookups", 20_000, agentspeak=1_000),
    single("join", "join", 5_000, unit="answer", count=5_000, agentspeak=500, ratio=12),
    single("fib(20) by goals", "fib_goals", 20, agentspeak=16, ratio=15, goal=25),
    single("fib(18) by rules", "fib_rules", 18, unit="call", count=8_361, goal=None, agentspeak=14),
    single("belief events", "events", 50_000, agentspeak=10_000, ratio=15),
    single("1000 intentions", "intentions", 100, k=1000, agentspeak=10, ratio=15),
    single("failures", "failures", 50_000, lacks="plans for failure", goal=None),
    single("list of 1000, 20 times", "lists", 20, k=1000, lacks="an end: over 170 s"),
    Workload(
        "messages", (("ping", "ping", 1), ("pong", "pong", 1)), 20_000,
        unit="message", count=20_000, goal=150, agentspeak=5_000,
    ),
    Workload("1000 agents", (("worker", "worker", 1000), ("boss", "boss", 1)), 100, k=1000, agentspeak=10, ratio=15),
    Workload("10,000 agents", (("worker", "worker", 10_000), ("boss", "boss", 1)), 10, k=10_000),
    single("percepts", "percepts", 2_000, unit="change", count=20_000, goal=None, lacks="an environment", jason=False),
    single("100 plans", "plans", 20_000, agentspeak=1_000),
    single("annotations", "annotations", 5_000, agentspeak=500),
    single("namespaces", "namespaces", 20_000, lacks="namespaces"),
)  # fmt: skip
