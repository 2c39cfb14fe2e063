"""Differential drive: how a base with limits moves through one step of time.  Pure functions on numbers."""

from jacaros.sim.description import RobotLimits
from jacaros.sim.trigonometry import sine_cosine, wrap


def clamp(value: float, most: float) -> float:
    """*value*, its magnitude cut to *most*."""
    if value > most:
        return most
    if value < -most:
        return -most
    return value


def approach(now: float, wanted: float, most: float) -> float:
    """Move *now* towards *wanted* by *most* at the most."""
    if wanted > now + most:
        return now + most
    if wanted < now - most:
        return now - most
    return wanted


def ramp(
    speed: float,
    turn_rate: float,
    wanted_speed: float,
    wanted_turn_rate: float,
    limits: RobotLimits,
    dt: float,
) -> tuple[float, float]:
    """Speed and turn rate (m/s, rad/s) after *dt* seconds of approaching the wanted ones within *limits*."""
    return (
        approach(speed, clamp(wanted_speed, limits.speed), limits.acceleration * dt),
        approach(turn_rate, clamp(wanted_turn_rate, limits.turn_rate), limits.turn_acceleration * dt),
    )


def advance(x: float, y: float, yaw: float, distance: float, turn: float) -> tuple[float, float, float]:
    """The pose after *distance* metres along an arc of *turn* radians, by the midpoint rule."""
    if distance != 0.0:
        sine, cosine = sine_cosine(yaw + 0.5 * turn)
        x += distance * cosine
        y += distance * sine
    return x, y, (wrap(yaw + turn) if turn != 0.0 else yaw)
