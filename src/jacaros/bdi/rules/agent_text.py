"""A mind as a program text: what ``.save_agent`` writes."""

from collections.abc import Iterable, Iterator

from jacaros.asl.formatter import format_plan, format_term
from jacaros.bdi.state.belief_base import literal
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.rule import OpenFact, Rule
from jacaros.terms.text import text
from jacaros.terms.values import SOURCE_SELF, Annotated, Term, annotations_of, bare


def agent_text(agent: Circumstance, goals: Iterable[Term]) -> str:
    """The beliefs, rules and plans of an agent, with initial goals."""
    parts = [
        "// beliefs and rules",
        *_beliefs(agent),
        "",
        "// initial goals",
        *(f"!{text(goal)}." for goal in goals),
        "",
        "// functions",
        *(
            f'{{ register_function("{name}", {function.arity}, "{function.implementation}") }}'
            for name, function in agent.functions.items()
        ),
        "",
        "// plans",
        *(format_plan(plan.node) for plan in agent.library.plans),
    ]
    return "\n".join(parts) + "\n"


def _beliefs(agent: Circumstance) -> Iterator[str]:
    for symbol, table in agent.beliefs.items():
        for entry, annotations in table.entries():
            if isinstance(entry, Rule):
                yield f"{format_term(entry.node)}."
            elif isinstance(entry, OpenFact):
                yield f"{text(_without_self(Annotated(bare(entry.head()), annotations)))}."
            else:
                yield f"{text(_without_self(literal(symbol, entry, annotations)))}."


def _without_self(belief: Term) -> Term:
    """The belief without its own source, which a program's beliefs get anyway."""
    kept = tuple(a for a in annotations_of(belief) if a != SOURCE_SELF)
    return Annotated(bare(belief), kept) if kept else bare(belief)
