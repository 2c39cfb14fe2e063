"""Goals that are achieved: finished plans leave the stack (rule ClrInt), and so do those whose goal condition holds."""

from jacaros.bdi.rules import meta_events, rescue
from jacaros.bdi.rules.stack import achieve
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.intention import GOAL, PLAN, Frame, Intention
from jacaros.bdi.state.waiting import GoalConditionWait
from jacaros.errors import InternalError
from jacaros.terms.text import text
from jacaros.terms.unifier import undo


def pop_finished(agent: Circumstance, intention: Intention) -> bool:
    """Rule ClrInt: take finished plans off the stack; False when the intention goes no further now."""
    frames = intention.frames
    while frames:
        frame = frames[-1]
        if frame[0] is not None:
            return True
        if frame[PLAN].goal_condition is not None and not _is_achieved(agent, frame):
            GoalConditionWait(intention).attach(frame, None)
            return False
        trigger = frame[GOAL][0]
        if trigger.failing:
            index = intention.handlers.pop()
            frame = frames[index]
            del frames[index:]
        else:
            frames.pop()
        if agent.meta and trigger.kind:
            meta_events.observe(agent, intention, frame, "recovered" if trigger.failing else "achieved")
            meta_events.goal_state(agent, frame[GOAL], frame[2], "achieved")
            meta_events.frame_state(agent, intention, frame, "finished")
        if agent.atomic is intention and not intention.is_atomic():
            agent.atomic_over = True
    agent.finish(intention)
    return False


def end_achieved_goals(agent: Circumstance) -> None:
    """Goals whose goal condition holds are achieved, whatever their plans are at."""
    for intention in list(agent.alive.values()):
        for index, frame in enumerate(intention.frames):
            if frame[PLAN].goal_condition is not None and _is_achieved(agent, frame):
                queued = agent.is_in_turn(intention)
                achieve(agent, intention, index)
                if intention.frames:
                    queued = queued or not pop_finished(agent, intention)
                else:
                    agent.finish(intention)
                    queued = True
                if not queued:
                    agent.make_ready(intention)
                break


def _is_achieved(agent: Circumstance, frame: Frame) -> bool:
    """Whether the goal condition of a frame holds; one that cannot be evaluated does not, which is told once."""
    achieved = frame[PLAN].goal_condition
    if achieved is None:
        return False
    try:
        return bool(achieved(agent, frame))
    except InternalError:
        raise
    except Exception as fault:
        undo(agent.trail, 0)
        if frame[PLAN] not in agent.blamed:
            agent.blamed.add(frame[PLAN])
            rescue.passed_over(agent, f"the goal condition of plan {text(frame[PLAN].label)}", fault)
        return False
