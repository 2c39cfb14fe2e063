"""Which intention has its turn: rule SelInt."""

from jacaros.bdi.rules.sel_ev import is_ready
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.intention import Intention


def select_intention(agent: Circumstance) -> Intention | None:
    """Rule SelInt: the atomic one, else round robin."""
    intentions = agent.intentions
    if agent.atomic is not None:
        atomic = agent.atomic
        if not is_ready(agent, atomic):
            return None
        if intentions[-1] is atomic:
            intentions.pop()
        else:
            intentions.remove(atomic)
        return atomic
    while intentions or agent.crowd:
        if not intentions:
            agent.let_in()
        intention = intentions.popleft()
        if intention.dropped:
            continue
        if intention.suspended is not None:
            intention.parked = True
            continue
        return intention
    return None
