"""Check for waits for an event that has already happened: the plan itself causes it before it waits.

>>> from jacaros.agents.language.loader import load_program
>>> from jacaros.agents.language.nodes import Declaration
>>> program, _ = load_program("robot.asl", "+!go <- !fetch; .wait({+fetched}). +!fetch <- +fetched.")
>>> known = KnownActions({".wait": Declaration(arity=(1, 3), awaits=True)})
>>> [each.help for each in missed_events(program, ByKind(program.plans), known)]
['wait for the belief instead of its event: `.wait(fetched)`']
"""

from collections.abc import Iterable, Iterator

from jacaros.agents.checks.goals import KnownActions, Signature, signature
from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import Diagnostic, problem
from jacaros.agents.language.lowering import format_term
from jacaros.agents.language.nodes import ByKind


def missed_events(program: nodes.Program, found: ByKind, known: KnownActions) -> Iterator[Diagnostic]:
    """Warn of ``.wait({+b})`` if only steps that come before it, or goals achieved before it, add the belief."""
    waits = [call for call in found.of(nodes.InternalAction) if known.of(call).awaits and _awaited(call)]
    if not waits:
        return
    causes = _Causes(program, found)
    for plan in found.of(nodes.Plan):
        before: list[nodes.Step] = []
        for step in plan.body.steps if isinstance(plan.body, nodes.Body) else ():
            call = step.formula if isinstance(step, nodes.Constraint) else None
            event = (
                _awaited(call) if isinstance(call, nodes.InternalAction) and known.of(call).awaits else None
            )
            if event is not None and causes.are_all_in(event, before):
                written = f"{event.functor}/{len(event.arguments)}"
                yield problem(
                    "event-never-happens",
                    f"event `+{written}` never happens here: only earlier steps of this plan add `{written}`",
                    event.span,
                    f"wait for the belief instead of its event: `.wait({format_term(event)})`",
                )
            before.append(step)


def _awaited(call: nodes.InternalAction) -> nodes.Literal | None:
    """Return the belief whose addition a ``.wait`` waits for."""
    first = call.arguments[0] if call.arguments else None
    steps = first.body.steps if isinstance(first, nodes.BodyTerm) else ()
    for step in steps:
        if (
            isinstance(step, nodes.BeliefChange)
            and step.operator == "+"
            and isinstance(step.operand, nodes.Literal)
        ):
            return step.operand
    return None


class _Causes:
    """The steps of a program that add beliefs, and the goals that lead to them."""

    def __init__(self, program: nodes.Program, found: ByKind) -> None:
        self._plans: dict[Signature, list[nodes.Plan]] = {}
        for plan in program.plans:
            if plan.trigger.kind == "!" and isinstance(plan.trigger.literal, nodes.Literal):
                self._plans.setdefault(signature(plan.trigger.literal), []).append(plan)
        self._posts = found.of(nodes.Achieve)
        changes = found.of(nodes.BeliefChange)
        self._adding = [
            each for each in changes if "+" in each.operator and isinstance(each.operand, nodes.Literal)
        ]
        written = [each.operand for each in changes if isinstance(each.operand, nodes.Literal)]
        # A belief that is the argument of an action may come in a message.
        calls = [*found.of(nodes.InternalAction), *found.of(nodes.ExternalAction), *program.beliefs]
        ours = set(map(id, written))
        self._elsewhere = {
            signature(each) for each in ByKind(*calls).of(nodes.Literal) if id(each) not in ours
        }

    def are_all_in(self, event: nodes.Literal, steps: Iterable[nodes.Step]) -> bool:
        """Return whether some of these steps, and nothing else, add a belief."""
        key = signature(event)
        adding = {
            id(each) for each in self._adding if each.operand is not event and signature(each.operand) == key
        }
        reached = {id(each) for each in self._reached(steps) if isinstance(each, nodes.BeliefChange)}
        return bool(adding) and adding <= reached and key not in self._elsewhere

    def _reached(self, steps: Iterable[nodes.Step]) -> Iterator[nodes.Node]:
        """Yield the nodes of steps, and of the plans for goals that only these steps achieve."""
        found = list(ByKind(*steps).of(nodes.BeliefChange, nodes.Achieve))
        seen: set[Signature] = set()
        while found:
            node = found.pop()
            yield node
            goal = node.goal if isinstance(node, nodes.Achieve) and not node.separate else None
            if isinstance(goal, nodes.Literal) and signature(goal) not in seen:
                key = signature(goal)
                seen.add(key)
                posts = [each for each in self._posts if signature(each.goal) == key]
                if len(posts) == 1:
                    found += ByKind(*self._plans.get(key, ())).of(nodes.BeliefChange, nodes.Achieve)
