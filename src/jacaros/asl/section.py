"""The clauses of a file or of a directive's block, while they are put together."""

from dataclasses import dataclass, field

from jacaros.asl import nodes


@dataclass
class Section:
    """Clauses in source order, per kind."""

    beliefs: list[nodes.Literal | nodes.Rule] = field(default_factory=list)
    goals: list[nodes.Literal] = field(default_factory=list)
    plans: list[nodes.Plan] = field(default_factory=list)
    functions: list[nodes.RegisteredFunction] = field(default_factory=list)

    def extend(self, other: "Section") -> None:
        """Put the clauses of *other* behind those of this one."""
        self.beliefs.extend(other.beliefs)
        self.goals.extend(other.goals)
        self.plans.extend(other.plans)
        self.functions.extend(other.functions)

    def program(self) -> nodes.Program:
        """The finished program."""
        return nodes.Program(tuple(self.beliefs), tuple(self.goals), tuple(self.plans), tuple(self.functions))
