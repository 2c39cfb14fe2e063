"""The programs that are measured, with their sizes and the engines that can run them."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from string import Template

PROGRAMS = Path(__file__).parent / "programs"
ARTIFACT = "board.py"
TIMES = 4
"""Number of repetitions in one process; with several, the first does not count."""


@dataclass(frozen=True)
class Workload:
    """A program of one size.  It does its work ``$times`` times, and prints ``begin`` and ``end`` around it.

    Attributes:
        name: shown in the table.
        agents: name, program file and number of instances of each.
        n, k: what ``$n`` and ``$k`` stand for in the programs.
        unit: what is counted.
        units_of: how many units the work has, for ``n`` and ``k``.
        goal: the most that a unit may cost, in empty Python calls with three arguments; None for no goal.
        faster: how many times faster than python-agentspeak it has to be; None for no goal.
        faster_jason: the same for Jason.
        sizes: ``n`` for engines that would take too long.
        lacks: by engine, what it lacks to run the program at all.
        artifact: whether it needs the artifact ``board.Board``.
    """

    name: str
    agents: tuple[tuple[str, str, int], ...]
    n: int
    units_of: Callable[[int, int], int]
    k: int = 0
    unit: str = "cycle"
    goal: float | None = 50
    faster: float | None = 12
    faster_jason: float | None = None
    sizes: Mapping[str, int] = field(default_factory=dict)
    lacks: Mapping[str, str] = field(default_factory=dict)
    artifact: bool = False

    def size_on(self, engine: str) -> int:
        """Return ``n`` for an engine."""
        return self.sizes.get(engine, self.n)

    @property
    def count(self) -> int:
        """Return the units of work at the size of the table."""
        return self.units_of(self.n, self.k)

    def write(self, folder: Path, n: int | None = None, times: int = TIMES) -> Path:
        """Write the project to *folder*; return its .mas2j file."""
        values = {"n": self.n if n is None else n, "k": self.k, "times": times, "plans": self._plans()}
        for file in {file for _, file, _ in self.agents}:
            source = Template((PROGRAMS / f"{file}.asl").read_text(encoding="utf-8"))
            (folder / f"{file}.asl").write_text(source.substitute(values), encoding="utf-8")
        if self.artifact:
            text = (PROGRAMS / ARTIFACT).read_text(encoding="utf-8")
            (folder / ARTIFACT).write_text(text, encoding="utf-8")
        lines = [
            f"    {name} {file}.asl{f' #{many}' if many > 1 else ''};" for name, file, many in self.agents
        ]
        project = folder / "bench.mas2j"
        world = "  environment: jacaros.Environment\n" if self.artifact else ""
        project.write_text(f"MAS bench {{\n{world}  agents:\n" + "\n".join(lines) + "\n}\n", encoding="utf-8")
        return project

    def _plans(self) -> str:
        """Return the replacement of ``$plans``: dozens of plans that would clutter the program."""
        if self.artifact:
            return "\n".join(f"+value{i}(X) : X > 0 <- Y = X + 1." for i in range(10))
        return "\n".join(f"+!do(kind{i}, X)." for i in range(1, 101))


def single(name: str, file: str, n: int, units_of: Callable[[int, int], int], **rest: object) -> Workload:
    """A workload of one agent."""
    return Workload(name, (("bench", file, 1),), n, units_of, **rest)  # type: ignore[arg-type]


def fibonacci_calls(n: int, k: int) -> int:
    """Return the number of calls for the naive Fibonacci number of *n*."""
    return 1 if n < 2 else 1 + fibonacci_calls(n - 1, k) + fibonacci_calls(n - 2, k)


def crowd(size: int, n: int, **rest: object) -> Workload:
    """Many agents that count at the same time."""
    agents = (("worker", "worker", size), ("boss", "boss", 1))
    return Workload(f"{size:,} agents", agents, n, lambda n, k: k * n + 7 * k + 7, k=size, **rest)  # type: ignore[arg-type]


ARTIFACTS = {"agentspeak": "an environment", "jason": "our artifacts"}

WORKLOADS = (
    single("goals", "count", 200_000, lambda n, k: n + 5, goal=25, faster=15, faster_jason=3, sizes={"agentspeak": 50_000}),
    single("while", "while", 100_000, lambda n, k: 2 * n + 6),
    single(
        "for", "for", 200_000, lambda n, k: 2 * n + 4,
        faster_jason=1.5, lacks={"agentspeak": ".range with three arguments"},
    ),
    single("facts", "facts", 50_000, lambda n, k: 2 * n + 6, faster_jason=3),
    single("look-ups in 200 facts", "lookups_again", 100_000, lambda n, k: n + 5, k=200, sizes={"agentspeak": 5_000}),
    single(
        "look-ups in 20,000 facts", "lookups_again", 100_000, lambda n, k: n + 5, k=20_000,
        sizes={"agentspeak": 50, "jason": 1_000},
    ),
    single("facts and look-ups", "lookups", 50_000, lambda n, k: 3 * n + 8, sizes={"agentspeak": 1_000, "jason": 5_000}),
    single(
        "join", "join", 50_000, lambda n, k: n, unit="answer", goal=None, sizes={"agentspeak": 700, "jason": 2_000},
    ),
    single("fib by goals", "fib_goals", 22, lambda n, k: 2 * fibonacci_calls(n, k) + 3, goal=25, faster=15, faster_jason=3),
    single("fib by rules", "fib_rules", 20, fibonacci_calls, unit="call", goal=None, faster_jason=1.5),
    single("belief events", "events", 50_000, lambda n, k: 3 * n + 6, faster=15, faster_jason=1.5),
    single(
        "1000 intentions", "intentions", 100, lambda n, k: k * n + 7 * k + 8, k=1000,
        faster=15, sizes={"agentspeak": 50},
    ),
    single(
        "failures", "failures", 50_000, lambda n, k: 5 * n + 5,
        faster_jason=1.4, lacks={"agentspeak": "plans for failure"},
    ),
    single("list of 1000", "lists", 100, lambda n, k: n * (k + 3) + k + 5, k=1000),
    Workload(
        "messages", (("ping", "ping", 1), ("pong", "pong", 1)), 50_000, lambda n, k: n,
        unit="message", goal=150, faster_jason=3,
    ),
    crowd(1000, 100, faster=15, sizes={"agentspeak": 50}),
    crowd(10_000, 20, faster=15),
    single(
        "percepts", "percepts", 2_000, lambda n, k: 10 * n, unit="change", goal=None, artifact=True, lacks=ARTIFACTS,
    ),
    single(
        "operations", "operations", 10_000, lambda n, k: n, unit="call", goal=None, artifact=True, lacks=ARTIFACTS,
    ),
    single("100 plans", "plans", 50_000, lambda n, k: 3 * n + 5, sizes={"agentspeak": 10_000}),
    single("annotations", "annotations", 10_000, lambda n, k: 3 * n + 8, sizes={"agentspeak": 1_000}),
    single(
        "1000 annotations of a belief", "stamps", 10, lambda n, k: n * k, k=1000, unit="annotation", goal=None, faster=None,
        lacks={"agentspeak": ".range with three arguments"},
    ),
    single(
        "beliefs in a queue", "queue", 5_000, lambda n, k: 3 * n, unit="step", goal=None, faster=None, faster_jason=1,
        lacks={"agentspeak": "+>"},
    ),
    single(
        "open beliefs", "open_beliefs", 2_000, lambda n, k: 3 * n, unit="step", goal=None, faster=None, faster_jason=1,
        lacks={"agentspeak": ".range with three arguments"},
    ),
    single(
        "waits for conditions", "waits", 5_000, lambda n, k: n, k=100, unit="wait", goal=None, faster=None,
        lacks={"agentspeak": "conditions in .wait"}, sizes={"jason": 1_000},
    ),
    single(
        "forks", "forks", 10, lambda n, k: n * k, k=1000, unit="fork", goal=None, faster=None, faster_jason=1,
        lacks={"agentspeak": "|&|"},
    ),
    single(
        "list in a belief", "growing", 10, lambda n, k: n * k, k=1000, unit="element", goal=None, faster=None,
        faster_jason=1, lacks={"agentspeak": ".range with three arguments"}, sizes={"jason": 2},
    ),
    single(
        "operations on lists of 2000", "list_operations", 100, lambda n, k: 9 * n, k=2000, unit="operation", goal=None,
        faster=None, faster_jason=1, lacks={"agentspeak": ".nth"},
    ),
    single(
        "strings", "strings", 5_000, lambda n, k: 7 * n, unit="operation", goal=None, faster=None, faster_jason=1.1,
        lacks={"agentspeak": ".term2string"},
    ),
    single(
        "deconstruction", "deconstruction", 20_000, lambda n, k: 2 * n, unit="term", goal=None, faster=None,
        faster_jason=1.1, lacks={"agentspeak": "=.. in both directions"},
    ),
    single(
        "random", "random", 20_000, lambda n, k: 3 * n, unit="number", goal=None, faster=None, faster_jason=1.1,
        lacks={"agentspeak": "random elements of a list"},
    ),
    single(
        "namespaces", "namespaces", 50_000, lambda n, k: 3 * n + 8,
        lacks={"agentspeak": "namespaces"}, sizes={"jason": 5_000},
    ),
)  # fmt: skip
