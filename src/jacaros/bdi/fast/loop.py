"""The reasoning cycle of an ordinary agent.

Replaces `jacaros.bdi.rules.cycle` with all that it calls: `sel_ev`, `applicable_plans`, `add_im`, `exec_int` and
`clr_int`. With empty queues, the next cycle would select the very event and intention of this one, so an intention
continues as long as nothing else needs a cycle. Rarer features of agents are left to the rules.
"""

from typing import Any

from jacaros.bdi.fast.beliefs import take_in, watch
from jacaros.bdi.rules import cycle as plain_cycle
from jacaros.bdi.rules import failure, meta_events
from jacaros.bdi.rules.add_im import add_frame, go_without, log_inapplicable
from jacaros.bdi.rules.clr_int import pop_finished
from jacaros.bdi.rules.cycle import begin_turn, deliberate, has_work, is_done, look_at_names
from jacaros.bdi.rules.exec_int import announce, execute, select_intention, step_failed, tell_waiting
from jacaros.bdi.rules.goal_failure import fail_intention, has_room
from jacaros.bdi.rules.perceiving import take_percepts
from jacaros.bdi.rules.proc_msg import read_message
from jacaros.bdi.rules.sel_ev import begin_with, handle_atomic_event, skip_event
from jacaros.bdi.state.circumstance import CROWD, Circumstance
from jacaros.bdi.state.intention import Frame, Intention
from jacaros.bdi.state.literals import EventAnnotations
from jacaros.bdi.state.plan import FAILED, SUSPENDED
from jacaros.bdi.state.triggers import Goal
from jacaros.errors import InternalError
from jacaros.terms.arithmetic import RUNNING
from jacaros.terms.unifier import undo
from jacaros.terms.values import BY_SELF


def run(agent: Circumstance, fuel: int) -> bool:  # noqa: C901 - written out for speed
    """Run at most *fuel* cycles; return True if there is more to do."""
    options = agent.options
    if options.search_limit and fuel > 1:
        # Each cycle gets the whole budget of searches.
        return all(run(agent, 1) for _ in range(fuel))
    if agent.crowd or options.search_limit:
        begin_turn(agent)
    # Calls inside terms are evaluated for this agent meanwhile.
    before = RUNNING.set(agent)  # pyright: ignore[reportArgumentType]
    agent.running = True
    try:
        begun = fuel
        if agent.sleep == "asleep":
            meta_events.awake(agent)
        events, intentions = agent.events, agent.intentions
        option_filter = agent.selections.option_filter
        always = options.percept_interval == 1
        while fuel > 0 and not agent.stopped:
            if (agent.incoming.called or not always) and agent.held is None:
                look_around(agent, agent.counts.cycles + begun - fuel)
                events, intentions = agent.events, agent.intentions
            if agent.features.special or option_filter.rows or not agent.selections.plain:
                made = agent.counts.cycles
                goes_on = deliberate(agent)
                made = agent.counts.cycles - made
                fuel, begun = fuel - made, begun - made
                if not goes_on:
                    break
                if is_done(agent):
                    agent.counts.cycles += begun - fuel
                    return False
                events, intentions = agent.events, agent.intentions
                continue
            intention: Intention | None = None
            if events:
                if agent.atomic is not None:
                    handle_atomic_event(agent, agent.atomic)
                else:
                    intention = handle_event(agent)
            if intention is None and (intentions or agent.crowd):
                intention = select_intention(agent)
            if intention is not None:
                try:
                    if agent.waits.events:
                        execute(agent, intention)
                        fuel -= 1
                    elif agent.atomic is not None:
                        fuel = execute_atomic(agent, intention, fuel)
                    else:
                        fuel = execute_usual(agent, intention, fuel)
                except InternalError:
                    raise
                except Exception as fault:
                    fuel -= 1
                    failure.drop_after_error(agent, agent.current or intention, fault)
                if agent.waits.requeued:
                    events.extendleft(reversed(agent.waits.requeued))
                    agent.waits.requeued.clear()
                elif not (
                    events or intentions or agent.crowd or agent.incoming.called or agent.features.edges
                ):
                    # That was all: the next cycle would find nothing to do.
                    agent.counts.cycles += begun - fuel
                    return False
            elif (events and agent.atomic is None) or agent.incoming.messages:
                fuel -= 1
            elif not (agent.incoming or (agent.features.edges and meta_events.fall_asleep(agent))):
                if not events and agent.atomic is None:
                    agent.counts.cycles += begun - fuel
                    return False
                break
        agent.counts.cycles += begun - fuel
        # Without fuel it was not seen yet that nothing is left to do: that takes another look.
        return not agent.stopped and (fuel <= 0 or has_work(agent))
    finally:
        agent.running = False
        RUNNING.reset(before)
        if agent.counts.cycles >= agent.counts.next_check:
            look_at_names(agent)
            watch(agent)


def look_around(agent: Circumstance, cycle: int) -> None:
    """Take in what has come since the last look: percepts and one message, if there is nothing else."""
    if (
        agent.incoming.tasks
        or (agent.waits.conditions and agent.waits.conditions.want_a_look())
        or (agent.incoming.messages and not agent.selections.plain)
        or agent.options.percept_interval != 1
    ):
        plain_cycle.look_around(agent, cycle)
        return
    agent.counts.next_check -= 1  # what comes in may bring new names as any step does
    # What is usual: there is a message, or percepts, and nothing else.
    if agent.incoming.percepts:
        take_percepts(agent, take_in)
        if agent.incoming.tasks:
            plain_cycle.do_tasks(agent)
            plain_cycle.check_conditions(agent)
    waiting = len(agent.incoming.messages)
    agent.incoming.called = waiting > 1 or agent.features.special or not agent.selections.plain
    if waiting:
        read_message(agent, agent.incoming.messages.popleft())


def handle_event(agent: Circumstance) -> Intention | None:  # noqa: C901 - written out for speed
    """Rule SelEv and the rules after it: handle one event; external events without a plan are skipped.

    If this begins an intention and there is no other, the intention need not queue: it is returned, and runs now.
    """
    events = agent.events
    while events:
        event = events.popleft()
        goal, intention, annotations, cause = event
        try:
            if intention is not None:
                if intention.dropped:
                    continue
                agent.current = intention  # contexts may ask for it
                if push(agent, intention, goal, annotations):
                    if intention.suspended is None:
                        agent.intentions.append(intention)
                agent.current = None
                return None
            # `begin_intention`, written out for what is usual.
            trail, kind = agent.trail, goal[0]
            trail.serial += 1
            select = agent.library.selects[kind]
            frame: Frame | None = None if select is None else select(agent, goal, annotations)
            if trail:
                trail.clear()
            if frame is None and not kind.kind and agent.features.usual_events:
                if select is not None and agent.options.verbose > 1:
                    log_inapplicable(agent, goal, annotations)
                continue
            if frame is None or frame[4].atomic or kind.failing:
                if begin_with(agent, event, frame, False):
                    return None
                continue
            agent.counts.intentions = number = agent.counts.intentions + 1
            agent.alive[number] = intention = Intention(number, cause)
            intention.frames.append(frame)
            intentions = agent.intentions
            if not intentions:
                return intention
            if len(intentions) >= CROWD and annotations is BY_SELF and kind.kind:
                agent.line_up(intention)
            else:
                intentions.append(intention)
            return None
        except InternalError:
            raise
        except Exception as fault:
            skip_event(agent, event, fault)
    return None


def push(agent: Circumstance, intention: Intention, goal: Goal, annotations: EventAnnotations) -> bool:
    """Put a plan for the goal on the intention; False when the intention goes no further now."""
    # What is usual: `select_plan` and `add_frame`, written out.
    trail = agent.trail
    trail.serial += 1
    kind = goal[0]
    select = agent.library.selects[kind]
    made: Frame | None = None if select is None else select(agent, goal, annotations)
    if trail:
        trail.clear()
    if made is None:
        return go_without(agent, intention, goal, annotations, None)
    frames = intention.frames
    if agent.atomic is None and not made[4].atomic and len(frames) < agent.options.goal_depth:
        if (
            frames
            and (caller := frames[-1])[0] is None
            and caller[1][0] is kind
            and kind.on_fail is not None
            and caller[4].replaceable
            and agent.options.tail_calls
        ):
            frames[-1] = made
        else:
            frames.append(made)
        return True
    return add_frame(agent, intention, made) or go_without(agent, intention, goal, annotations, made)


def execute_atomic(agent: Circumstance, intention: Intention, fuel: int) -> int:
    """Run steps of an atomic intention while no new input arrives; return the remaining fuel.

    After a step it is the last of those that can run, and the one that `select_intention` would find.
    """
    intentions = agent.intentions
    while True:
        execute(agent, intention)
        fuel -= 1
        if (
            fuel <= 0
            or agent.atomic is not intention
            or agent.incoming.called
            or agent.stopped
            or not intentions
            or intentions[-1] is not intention
        ):
            return fuel
        intentions.pop()


def execute_usual(agent: Circumstance, intention: Intention, fuel: int) -> int:  # noqa: C901 - see below
    """Run steps of one intention while nothing else needs a cycle; return the remaining fuel.

    An agent spends its time here, so what happens in nearly every cycle is inlined: `pop_finished`, `is_alone`,
    `select_plan` and `add_frame`. If a step makes the agent an unusual one, the next cycle continues, with the same
    effect when the queues are empty.
    """
    agent.current = intention
    frames, handlers, trail, selects = (
        intention.frames,
        intention.handlers,
        agent.trail,
        agent.library.selects,
    )
    events, intentions = agent.events, agent.intentions
    option_filter, depth, tail_calls = (
        agent.selections.option_filter,
        agent.options.goal_depth,
        agent.options.tail_calls,
    )
    urgencies = agent.selections.urgencies
    frame: Frame = frames[-1]
    while True:
        fuel -= 1
        goal: Any = None
        step = frame[0]
        if step is not None:
            try:
                goal = step(agent, frame)
            except InternalError:
                raise
            except Exception as fault:
                goal = step_failed(agent, intention, fault)
                if goal is None:
                    break
            if trail:
                if goal is FAILED:
                    undo(trail, 0)
                else:
                    trail.clear()
        if agent.stopped or intention.dropped or (goal is None and intention.suspended is not None):
            break

        if goal is None:
            if frame[0] is None:
                if agent.features.special:
                    if not pop_finished(agent, intention):
                        break
                else:
                    while frames and (top := frames[-1])[0] is None:
                        if handlers and top[1][0].failing:
                            del frames[handlers.pop() :]
                        else:
                            frames.pop()
                    if not frames:
                        if intention.waiting is None:
                            # `finish`, written out.
                            intention.dropped = True
                            agent.alive.pop(intention.id, None)
                        else:
                            agent.finish(intention)
                        break
            if intentions or events or agent.incoming.called or fuel <= 0:
                intentions.append(intention)
                break
            frame = frames[-1]
            continue

        annotations: EventAnnotations = BY_SELF
        if goal.__class__ is not tuple:
            if goal is SUSPENDED:
                if agent.features.meta:
                    tell_waiting(agent, intention)
                break
            if goal is FAILED:
                goal = fail_intention(agent, intention, failure.step_failure(frames[-1]))
                if goal is None:
                    break
            goal, annotations = goal.goal, goal.annotations
        if urgencies is not None and urgencies[goal[0]]:
            agent.selections.rank()
        if intentions or events or agent.incoming.called or option_filter.rows or fuel <= 0:
            announce(agent, intention, goal, annotations)
            events.append((goal, intention, annotations, None))
            break
        trail.serial += 1
        kind = goal[0]
        select = selects[kind]
        made: Frame | None = None if select is None else select(agent, goal, annotations)
        if trail:
            trail.clear()
        if made is None:
            if not go_without(agent, intention, goal, annotations, None):
                break
            made = frames[-1]
        elif (
            frame[0] is None
            and frames[-1] is frame
            and frame[1][0] is kind
            and kind.on_fail is not None
            and tail_calls
            and frame[4].replaceable
        ):
            frames[-1] = made
        else:
            frames.append(made)
            if len(frames) > depth and not has_room(agent, intention):
                if not go_without(agent, intention, goal, annotations, made):
                    break
                made = frames[-1]
        frame = made
        if frame[4].atomic:
            agent.atomic, agent.atomic_over = intention, False
            agent.make_ready(intention)
            break
    agent.current = None
    return fuel
