"""One robot of a running world: its true state, its motion, its odometry and its battery."""

import math
import random
from collections.abc import Callable
from typing import Any

from jacaros.robots.plane.contact import Push, WallIndex, push_apart, push_out
from jacaros.robots.plane.pose import Placement, Pose, clamp, wrap
from jacaros.robots.plane.shapes import Circle, Rectangle
from jacaros.robots.plane.trigonometry import sine_cosine
from jacaros.robots.world.data.ground_truth import PathSample, RobotState
from jacaros.robots.world.data.robot import BatterySettings, OdometrySettings, RobotDescription
from jacaros.robots.world.data.world import Dock


def approach(now: float, wanted: float, most: float) -> float:
    """Move *now* towards *wanted* by at most *most*."""
    if wanted > now + most:
        return now + most
    if wanted < now - most:
        return now - most
    return wanted


def advance(x: float, y: float, yaw: float, distance: float, turn: float) -> tuple[float, float, float]:
    """Return the pose after *distance* metres along an arc of *turn* radians, by the midpoint rule."""
    if distance != 0.0:
        sine, cosine = sine_cosine(yaw + 0.5 * turn)
        x += distance * cosine
        y += distance * sine
    return x, y, (wrap(yaw + turn) if turn != 0.0 else yaw)


# A uniform number of width sqrt(12) has variance 1. Not a Gaussian, whose logarithm comes from the C library.
_WIDTH = math.sqrt(12.0)


class WheelOdometry:
    """The pose estimated from the wheels.

    The standard deviation of errors grows with the square root of the distance in the step, hence of its duration: the
    error accumulated over a metre does not depend on the length of the steps.

    Attributes:
        x, y, yaw: the estimated pose (metres, radians).
        rolled, turned: total signed distance (m) and rotation (rad) of the wheels.
    """

    __slots__ = ("_draw", "rolled", "settings", "turned", "x", "y", "yaw")

    def __init__(self, settings: OdometrySettings, start: Pose, seed: str) -> None:
        self.settings = settings
        self.x, self.y, self.yaw = (0.0, 0.0, 0.0) if settings.from_start else start
        self.rolled = self.turned = 0.0
        self._draw = random.Random(seed).random

    @property
    def placement(self) -> Placement:
        """The estimated pose, with the cosine and sine of the heading."""
        return Placement.at(self.x, self.y, self.yaw)

    def step(self, distance: float, turn: float) -> None:
        """Add *distance* metres and *turn* radians made by the wheels in one step."""
        settings = self.settings
        self.rolled += distance
        self.turned += turn
        if settings.noisy:
            way, angle = abs(distance), abs(turn)
            distance += self._error(settings.per_metre, way)
            turn += self._error(settings.per_radian, angle) + self._error(settings.turn_per_metre, way)
        self.x, self.y, self.yaw = advance(self.x, self.y, self.yaw, distance, turn)

    def _error(self, deviation: float, way: float) -> float:
        return (self._draw() - 0.5) * _WIDTH * deviation * math.sqrt(way) if deviation and way else 0.0


STILL_SPEED = 0.02
"""Speed in m/s below which a dock considers a robot at rest."""
STILL_TURN_RATE = 0.1
"""The same for turning on the spot, in rad/s."""

HALF_TRACK = 0.115
"""Distance from the centre to a wheel in metres, as of a TurtleBot 2."""

BUMP = 0.1
"""Metres by which a bump may move a robot unnoticed by its wheels."""
LIFTED = 0.5
"""Seconds for which the wheels of a carried robot hang down, when it is put down."""
WALL = "wall"


class Robot:
    """The true state of a robot.

    Attributes:
        description: description from the world file.
        x, y, yaw: true pose (metres, radians); speed, turn_rate: velocity of the base (m/s, rad/s).
        odometry: estimated pose. odometer: metres truly driven.
        battery: its battery. dock: dock that it stands in, or None.
        tasks: number of tasks that it has announced.
        fallen: whether it has fallen down a cliff, after which it does not move.
        grip: returns the fraction of the wheel motion that moves the robot, from 0 to 1, for each step; None for full grip.
        blocked_wheel: ``left``, ``right`` or ``both``; "" for none.
        has_current: returns whether a dock gives charging current.
        misses: returns, for each grasp, whether its gripper misses; None if it does not.
        misled: pose that its localisation jumps to at the next message; None for none.
        put_downs: number of times it was put down elsewhere.
        shaken: metres by which slip and bumps may have moved it unnoticed by its wheels, in total.
        touching: names of what it touches: ``wall`` or other robots. contacts: the side of each contact, by name.
    """

    def __init__(
        self, description: RobotDescription, seed: int, note: Callable[["Robot", str, dict[str, Any]], None]
    ) -> None:
        self.description = description
        self.name = description.name
        self.x, self.y, self.yaw = description.pose
        self.speed = self.turn_rate = self.odometer = 0.0
        self.wanted_speed = self.wanted_turn_rate = 0.0
        self.odometry = WheelOdometry(description.odometry, description.pose, f"{seed}/{self.name}/odometry")
        self.battery = Battery(description.battery)
        self.dock: Dock | None = None
        self.tasks = 0
        self.fallen = False
        self._lifted = 0.0
        self.grip: Callable[[], float] | None = None
        self.blocked_wheel = ""
        self.has_current: Callable[[Dock], bool] = lambda dock: True
        self.misses: Callable[[], bool] | None = None
        self.misled: Pose | None = None
        self.put_downs, self.shaken = 0, 0.0
        self.touching: frozenset[str] = frozenset()
        self.contacts: dict[str, str] = {}
        self._silence = math.inf
        self._touched: dict[str, str] = {}
        self._note = note

    @property
    def pose(self) -> Pose:
        """The true pose."""
        return Pose(self.x, self.y, self.yaw)

    @property
    def placement(self) -> Placement:
        """The same, with the cosine and sine of the heading."""
        return Placement.at(self.x, self.y, self.yaw)

    @property
    def circle(self) -> Circle:
        """Its true position and radius, in metres."""
        return self.x, self.y, self.description.radius

    @property
    def fed(self) -> bool:
        """Whether a dock supplies it with current."""
        return self.dock is not None and self.has_current(self.dock)

    @property
    def wheels_drop(self) -> bool:
        """Whether its wheels hang in the air: it has fallen, or was carried just now."""
        return self.fallen or self._lifted > 0.0

    @property
    def rolling(self) -> bool:
        """Whether its motors turn its wheels, or would if none was blocked."""
        return self.speed != 0.0 or self.turn_rate != 0.0

    @property
    def moving(self) -> bool:
        """Whether the base moves or has a command to move."""
        return self.speed != 0.0 or self.turn_rate != 0.0 or self._has_command()

    def tell(self, kind: str, data: dict[str, Any]) -> None:
        """Add an event of the robot to the ground truth."""
        self._note(self, kind, data)

    def sample(self, time: float) -> PathSample:
        """Return the state as a point of the path."""
        return PathSample(time, *self.state(), self.odometer)

    def state(self) -> RobotState:
        """Return the true pose, the battery and the contacts."""
        battery = self.battery
        return RobotState(self.x, self.y, self.yaw, battery.level, battery.charging, bool(self.touching))

    def command(self, speed: float, turn_rate: float) -> None:
        """Set a velocity command (m/s, rad/s) for the next step; numbers that are not finite mean stop."""
        if not (math.isfinite(speed) and math.isfinite(turn_rate)):
            self.tell("bad_command", {"speed": repr(speed), "turn_rate": repr(turn_rate)})
            speed = turn_rate = 0.0
        if self.fallen:
            return
        self.wanted_speed, self.wanted_turn_rate = speed, turn_rate
        self._silence = 0.0

    def _has_command(self) -> bool:
        return self.wanted_speed != 0.0 or self.wanted_turn_rate != 0.0

    def step(self, dt: float, walls: WallIndex) -> None:
        """Drive for *dt* seconds, with contacts to walls; the world handles other robots and docks."""
        self._touched = {}
        self._lifted = max(0.0, self._lifted - dt)
        if not self.moving:
            if WALL in self.touching:
                self._touched[WALL] = self.contacts.get(WALL, "")
            self.battery.step(dt, 0.0, 0.0, self.fed)
            return
        self._watch_commands(dt)
        limits = self.description.limits
        wanted, wanted_turn = (
            clamp(self.wanted_speed, limits.speed),
            clamp(self.wanted_turn_rate, limits.turn_rate),
        )
        self.speed = approach(self.speed, wanted, limits.acceleration * dt)
        self.turn_rate = approach(self.turn_rate, wanted_turn, limits.turn_acceleration * dt)
        distance, turn = self._roll(dt)
        rolled, turned = distance, turn
        if self.grip is not None:
            grip = self.grip()
            self.shaken += (1.0 - grip) * (abs(distance) + HALF_TRACK * abs(turn))
            distance, turn = grip * distance, grip * turn
        before_x, before_y = self.x, self.y
        self.x, self.y, self.yaw = advance(self.x, self.y, self.yaw, distance, turn)
        if self._leave_walls(walls):
            # Wheels stall at a wall: they roll only as far as the robot truly moved along its heading.
            sine, cosine = sine_cosine(self.yaw - 0.5 * turn)
            came = (self.x - before_x) * cosine + (self.y - before_y) * sine
            distance = min(max(came, 0.0), distance) if distance > 0.0 else max(min(came, 0.0), distance)
            rolled = distance
            self.speed = distance / dt
        self.odometer += abs(distance)
        self.odometry.step(rolled, turned)
        self.battery.step(dt, rolled, turned, self.fed)

    def _roll(self, dt: float) -> tuple[float, float]:
        """Return distance (m) and rotation (rad) of the wheels in a step of *dt* seconds."""
        distance, turn = self.speed * dt, self.turn_rate * dt
        if not self.blocked_wheel:
            return distance, turn
        left, right = distance - HALF_TRACK * turn, distance + HALF_TRACK * turn
        left = 0.0 if self.blocked_wheel in ("left", "both") else left
        right = 0.0 if self.blocked_wheel in ("right", "both") else right
        return 0.5 * (left + right), 0.5 * (right - left) / HALF_TRACK

    def put_down(self, pose: Pose) -> None:
        """Put the robot down at another place; the wheels drop on the way, and odometry does not notice."""
        self.x, self.y, self.yaw = pose
        self.speed = self.turn_rate = 0.0
        self.put_downs += 1
        self._lifted = LIFTED

    def _watch_commands(self, dt: float) -> None:
        """Brake immediately, without a ramp, when commands cease or the battery is empty."""
        late = self._silence + 1e-9 > self.description.limits.command_timeout
        self._silence += dt
        if late and self._has_command():
            self.tell("command_timeout", {"speed": self.speed, "turn_rate": self.turn_rate})
        if late or self.battery.empty:
            self.wanted_speed = self.wanted_turn_rate = 0.0
            self.speed = self.turn_rate = 0.0

    def _leave_walls(self, walls: WallIndex) -> bool:
        """Push the robot out of the walls; return whether it moved."""
        near = walls.near(self.x, self.y)
        if not near:
            return False
        x, y, towards = push_out(self.x, self.y, self.description.radius, near)
        if towards is None:
            return False
        self._touched[WALL] = self.side(*towards)
        pushed = x != self.x or y != self.y
        self.x, self.y = x, y
        return pushed

    def touch(self, other: str, push: Push, walls: WallIndex, dt: float) -> None:
        """Apply a push by something else, such as another robot."""
        push_x, push_y, towards_x, towards_y = push
        self._touched[other] = self.side(towards_x, towards_y)
        if self.fallen or (push_x == 0.0 and push_y == 0.0):
            return
        self.x += push_x
        self.y += push_y
        sine, cosine = sine_cosine(self.yaw)
        rolled = push_x * cosine + push_y * sine
        self.odometry.step(rolled, 0.0)
        if rolled * self.speed < 0.0:
            slower = self.speed + rolled / dt
            self.speed = slower if slower * self.speed > 0.0 else 0.0
        self._leave_walls(walls)

    def hold_off(self, other: str, x: float, y: float, radius: float, walls: WallIndex, dt: float) -> None:
        """Apply the push by a disc that does not move, such as a person."""
        push = push_apart(self.x, self.y, x, y, self.description.radius + radius)
        if push is not None:
            push_x, push_y, towards_x, towards_y = push
            self.touch(other, (2.0 * push_x, 2.0 * push_y, towards_x, towards_y), walls, dt)

    def side(self, towards_x: float, towards_y: float) -> str:
        """Return the side of the robot that faces a direction of the world: front, back, left or right."""
        ahead, left = Placement.at(0.0, 0.0, self.yaw).local(towards_x, towards_y)
        if abs(ahead) >= abs(left):
            return "front" if ahead > 0.0 else "back"
        return "left" if left > 0.0 else "right"

    def settle_contacts(self) -> None:
        """End a step: record every new contact."""
        if not self._touched and not self.touching:
            return
        for other, side in self._touched.items():
            if other not in self.touching:
                self.shaken += BUMP
                if other == WALL:
                    self.tell("bump", {"side": side})
                else:
                    self.tell("collision", {"with": other, "side": side})
        self.touching = frozenset(self._touched)
        self.contacts = self._touched

    def settle_fall(self, cliffs: tuple[Rectangle, ...]) -> None:
        """End a step: a robot with its centre over a cliff falls, and stays there."""
        if not self.fallen and any(cliff.contains(self.x, self.y) for cliff in cliffs):
            self.fallen = True
            self.speed = self.turn_rate = self.wanted_speed = self.wanted_turn_rate = 0.0
            self.tell("fell", {})

    def settle_dock(self, docks: tuple[Dock, ...]) -> None:
        """End a step: update the dock. Passing through a dock is not docking."""
        dock = None
        if abs(self.speed) <= STILL_SPEED and abs(self.turn_rate) <= STILL_TURN_RATE:
            dock = next((dock for dock in docks if self._within(dock)), None)
        if dock is not self.dock:
            if self.dock is not None:
                self.tell("undocked", {"dock": self.dock.name})
            if dock is not None:
                self.tell("docked", {"dock": dock.name})
            self.dock = dock
            # Immediately, not in the next step: a docked robot that is not charging would seem to be full.
            self.battery.feed(self.fed)

    def _within(self, dock: Dock) -> bool:
        dx, dy = self.x - dock.pose.x, self.y - dock.pose.y
        return dx * dx + dy * dy <= dock.radius * dock.radius


FULL_VOLTAGE = 16.4
EMPTY_VOLTAGE = 12.8


class Battery:
    """A battery with a level in percent, 0 to 100.

    Attributes:
        level: remaining percent.
        charging: whether a dock supplies current and the battery is not full.
    """

    __slots__ = ("charging", "level", "settings")

    def __init__(self, settings: BatterySettings) -> None:
        self.settings = settings
        self.level = settings.level
        self.charging = False

    def step(self, dt: float, distance: float, turn: float, docked: bool) -> None:
        """Advance by *dt* seconds in which the robot drove *distance* metres and turned *turn* radians."""
        settings = self.settings
        drain = settings.drain_per_second * dt
        drain += settings.drain_per_metre * abs(distance) + settings.drain_per_radian * abs(turn)
        if docked:
            # The dock supplies the robot, too, so a full battery stays full.
            level = self.level + settings.charge_per_second * dt
            self.level = 100.0 if level > 100.0 else level
        else:
            self.level = self.level - drain if self.level > drain else 0.0
        self.feed(docked)

    def feed(self, docked: bool) -> None:
        """Start or stop charging."""
        self.charging = docked and self.level < 100.0

    @property
    def empty(self) -> bool:
        """Whether the motors have no current."""
        return self.level <= 0.0

    @property
    def voltage(self) -> float:
        """Volts, linear between a full and an empty four-cell battery."""
        return EMPTY_VOLTAGE + (FULL_VOLTAGE - EMPTY_VOLTAGE) * self.level / 100.0
