"""Alarms: module functions called at a moment of the run's clock, so that a stored mind can contain them."""

from collections.abc import Callable
from functools import partial
from typing import Any

from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.waiting import Alarm


def set_alarm(agent: Circumstance, delay: float, function: Callable[..., None], *arguments: Any) -> Alarm:
    """Call *function* with the agent and the arguments after *delay* seconds of the run's clock."""
    agent.waits.alarms_made += 1
    alarm = Alarm(agent.waits.alarms_made, agent.architecture.now() + delay, function, arguments)
    agent.waits.alarms[alarm.number] = alarm
    start_alarm(agent, alarm, delay)
    return alarm


def start_alarm(agent: Circumstance, alarm: Alarm, delay: float) -> None:
    """Have the host ring after *delay* seconds."""
    alarm.timer = agent.architecture.set_timer(delay, partial(_ring, agent, alarm))


def cancel_alarm(agent: Circumstance, alarm: Alarm) -> None:
    """Cancel an alarm; no effect if it has rung."""
    if agent.waits.alarms.pop(alarm.number, None) is not None:
        alarm.timer.cancel()


def _ring(agent: Circumstance, alarm: Alarm) -> None:
    del agent.waits.alarms[alarm.number]
    alarm.function(agent, *alarm.arguments)
