"""Plans and frames as terms."""

from jacaros.bdi.circumstance import Circumstance
from jacaros.bdi.intention import PLAN, Frame
from jacaros.compiler.lowering import fresh_names, lower_plan
from jacaros.compiler.plan import Plan
from jacaros.terms.substitution import resolve
from jacaros.terms.values import Term, atom, make_list, structure


def plan_term(agent: Circumstance, plan: Plan) -> Term:
    """A plan of an agent as a term, with its label and what is known of it."""
    term = lower_plan(plan.node, fresh_names())
    return (term[0], agent.library.label(plan), *term[2:])


def variables_of(frame: Frame) -> dict[str, Term]:
    """The variables of a frame that have been given a value."""
    slots = frame[PLAN].slots
    return {
        name: frame[slot] for name, slot in slots.items() if slot < len(frame) and frame[slot] is not None
    }


def bindings_of(frame: Frame) -> Term:
    """The list ``[map('Var', Value), …]`` of a frame."""
    return make_list(
        [structure("map", atom(f"'{name}'"), resolve(value)) for name, value in variables_of(frame).items()]
    )
