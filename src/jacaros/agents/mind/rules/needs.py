"""Plans and goals that need resources: acquired before the first step, released when their frame is gone."""

from jacaros.agents.mind.state.act import NEEDS, Act
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import ANNOTATIONS, GOAL, PLAN, STEP, Frame, Intention
from jacaros.agents.mind.state.pending import Need, Waiting, Wanted, wanted_in
from jacaros.agents.terms.values import String, atom, make_list, structure


def acquire(agent: Circumstance, intention: Intention) -> bool:
    """Request what the plan or goal on top of an intention needs; return False if the intention waits for it."""
    frame = intention.frames[-1]
    wanted = _wanted(frame)
    if wanted is None or frame[STEP] is None:
        return True
    return agent.begin_need(intention, frame, wanted)


def _wanted(frame: Frame) -> Wanted | None:
    own: Wanted | None = frame[PLAN].needs
    trigger = frame[GOAL][0]
    given = frame[ANNOTATIONS]
    if trigger.kind != "!" or trigger.operator != "+" or given.__class__ is not tuple:
        return own
    asked = wanted_in(given)
    if own is None or asked is None:
        return own or asked
    return Wanted(tuple(dict.fromkeys((*own.names, *asked.names))), asked.policy)


def act_for(agent: Circumstance, number: int, intention: Intention, frame: Frame, wanted: Wanted) -> Act:
    """Return the act by which an intention requests resources; it ends when they are granted."""
    trigger = frame[GOAL][0]
    arguments = (
        make_list([String(name) for name in wanted.names]),
        atom(wanted.policy),
        String(f"{trigger.operator if trigger.kind == '' else ''}{trigger.kind}{trigger.functor.name}"),
    )
    act = Act(number, NEEDS, arguments, (), intention.id, intention.cause)
    claim(agent, intention, act)
    return act


def claim(agent: Circumstance, intention: Intention, act: Act) -> None:
    """Set in an act what claims depend on: its urgency, and the acts that contain it."""
    act.urgency = agent.selections.urgency_of(intention)
    if agent.atomic is intention:
        act.yields = False
    if agent.waits.needs:
        act.within = tuple(each.number for each in of(agent, intention))


def wait(agent: Circumstance, intention: Intention, frame: Frame, number: int, wanted: Wanted) -> Waiting:
    """Let an intention wait for what it has requested."""
    reason = structure("needs", *(atom(name) for name in wanted.names))
    waiting = Waiting(intention, reason, number)
    waiting.attach(frame, frame[STEP])
    agent.waits.acts[number] = waiting
    return waiting


def of(agent: Circumstance, intention: Intention) -> list[Need]:
    """Return what an intention needs, the lowest on its stack first."""
    return [need for need in agent.waits.needs.values() if need.is_on(intention)]


def sweep(agent: Circumstance) -> None:
    """Release resources of frames that are gone, however they ended."""
    for need in list(agent.waits.needs.values()):
        if not need.intention.dropped and need.is_on(need.intention):
            continue
        heir = next((each for each in agent.alive.values() if need.is_on(each)), None)
        if heir is not None:
            need.intention = heir
            continue
        del agent.waits.needs[need.number]
        agent.waits.preempted.pop(need.number, None)
        agent.architecture.cancel_act(need.number)
