"""The commands of pages, by name; each gets a reply, even if it is invalid.

A command is a function: its parameters are the fields of the command, checked by their types, and, if it is called
``session``, the session of the page.
"""

import inspect
import re
from collections.abc import Awaitable, Callable, Mapping
from functools import wraps
from typing import Annotated, Any, Literal, get_args, get_origin, get_type_hints

from msgspec import Meta, Struct, ValidationError, convert, defstruct
from msgspec.structs import asdict

from jacaros.agents.body.values import Outputs, to_value
from jacaros.agents.language.diagnostics import one_line
from jacaros.agents.language.loader import parse_literal
from jacaros.agents.language.lowering import Variables, lower_value
from jacaros.agents.terms.values import Var, bare
from jacaros.artifacts.env.environment import Environment
from jacaros.artifacts.env.errors import OperationFailed
from jacaros.artifacts.env.values import text as value_text
from jacaros.look.records.records import FiniteNumber
from jacaros.robots.world import World
from jacaros.robots.world.data.world import PersonDescription
from jacaros.runtime.clock import of_run
from jacaros.runtime.errors import JacarosError
from jacaros.runtime.mas.debugging.debugger import Debugger, StepKind
from jacaros.runtime.mas.system import System
from jacaros.serving.artifacts import all_artifacts, call
from jacaros.serving.callers import LONGEST
from jacaros.serving.service import Session

RADIUS = 0.2
"""Default radius of an obstacle, in metres."""

Given = Mapping[str, Any]
SESSION = "session"
Text = Annotated[str, Meta(pattern=r"\S", max_length=LONGEST)]
Command = Callable[..., Awaitable[Any] | Any]
"""Takes the fields of a command and returns the result; raises `Refused`, `JacarosError` or `OperationFailed`."""


class Refused(Exception):
    """Raised for a command that cannot be executed; the text says why, in one line."""


class Commands:
    """The commands available to pages.

    Args:
        note: called with a text for each command that changed something.
    """

    def __init__(self, note: Callable[[str], None] = lambda _: None) -> None:
        self._known: dict[str, tuple[Callable[..., Any], type[Struct], bool, bool]] = {}
        self._note = note

    @property
    def names(self) -> list[str]:
        """Names of the available commands, sorted."""
        return sorted(self._known)

    def add(self, commands: Mapping[str, Command], changes: bool = False) -> None:
        """Add commands; if they are *changes* of the run, each success is recorded."""
        for name, command in commands.items():
            takes_session = SESSION in inspect.signature(command).parameters
            self._known[name] = command, _fields_of(command), takes_session, changes

    async def answer(self, given: Given, session: Session | None = None) -> dict[str, Any]:
        """Execute a command of a page with this session, and return the reply."""
        reply: dict[str, Any] = {"kind": "reply", "id": given.get("id")}
        try:
            return {**reply, "ok": True, "result": await self._execute(str(given.get("do")), given, session)}
        except (Refused, JacarosError, OperationFailed) as refused:
            return {**reply, "ok": False, "error": one_line(refused)}
        except Exception as error:  # a page must not end the run
            return {**reply, "ok": False, "error": f"{type(error).__name__}: {str(error)[:200]}"}

    async def _execute(self, name: str, given: Given, session: Session | None) -> Any:
        if name not in self._known:
            raise Refused(f"unknown command here: `{name[:40]}`")
        command, fields, takes_session, changes = self._known[name]
        values = _values(given, fields)
        if takes_session:
            values[SESSION] = session
        with of_run():  # tasks started by a command pause with the run
            result = command(**values)
        if inspect.isawaitable(result):
            result = await result
        if changes:
            self._note(said(name, given))
        return result


def _fields_of(command: Command) -> type[Struct]:
    parameters = inspect.signature(command, eval_str=True).parameters.values()
    return defstruct(
        "Fields",
        [
            (each.name, each.annotation)
            if each.default is each.empty
            else (each.name, each.annotation, each.default)
            for each in parameters
            if each.name != SESSION
        ],
    )


def _values(given: Given, fields: type[Struct]) -> dict[str, Any]:
    try:
        values = asdict(convert(given, fields))
    except ValidationError as error:
        found = re.search(r"\$\.(\w+)", str(error))
        kind = get_type_hints(fields)[found[1]] if found else None
        if found and get_origin(kind) is Literal:
            raise Refused(f"`{found[1]}` must be one of {', '.join(get_args(kind))}") from None
        raise Refused(str(error)) from None
    return {name: value.strip() if isinstance(value, str) else value for name, value in values.items()}


_SAID = {
    "operate": "{artifact}: {text}",
    "move_robot": "{robot} moved to ({x}, {y})",
    "battery": "battery of {robot}: {level} %",
    "door": "door {name} open: {open}",
    "fault": "fault {name} on: {on}",
}
"""How records name the change made by a command; other commands by name and fields."""


def said(name: str, given: Given) -> str:
    """Return a command as a line of text, such as ``battery of turtlebot: 20 %``."""
    fields = {key: str(value)[:200] for key, value in given.items() if key not in ("id", "do")}
    try:
        return _SAID[name].format_map(fields)
    except KeyError:
        return f"{name} {' '.join(f'{key}={value}' for key, value in fields.items())}".strip()


# ---- the debugger


def debug_commands(debugger: Debugger) -> Mapping[str, Command]:
    """Return the commands of a debugger; the speed can be changed only in real time."""

    def pause() -> None:
        debugger.pause()

    def step(what: StepKind, agent: Text | None = None) -> None:
        debugger.step(what, agent)

    def speed(factor: FiniteNumber) -> None:
        debugger.speed = factor

    def breakpoint(at: dict[str, Any], op: Literal["add", "remove"]) -> list[str]:
        if op == "add":
            debugger.add_breakpoint(at)
        elif not debugger.remove_breakpoint(at):
            raise Refused("this breakpoint is not set")
        return [each.text for each in debugger.breakpoints]

    found: dict[str, Command] = {
        "pause": pause,
        "continue": debugger.resume,
        "step": step,
        "breakpoint": breakpoint,
        "reload": lambda: "\n".join(debugger.reload()),
    }
    return {**found, "speed": speed} if debugger.has_speed else found


# ---- the embedded world


def world_commands(system: System, world: World, show: Callable[[], None]) -> Mapping[str, Command]:
    """Return the commands for the embedded world of a system; *show* updates the view after a change."""
    visitors: list[str] = []

    def door(name: Text, open: bool) -> None:
        _refuse(world.move_door(name, open))

    def obstacle(
        x: FiniteNumber | None = None,
        y: FiniteNumber | None = None,
        radius: FiniteNumber = RADIUS,
        remove: Text | None = None,
    ) -> str:
        if remove is None:
            return world.add_obstacle(*_place(x, y), radius)
        world.remove_obstacle(remove)
        return remove

    def person(
        x: FiniteNumber | None = None, y: FiniteNumber | None = None, remove: Text | None = None
    ) -> str:
        if remove is not None:
            world.remove_person(remove)
            return remove
        place = _place(x, y)
        visitor = PersonDescription(f"visitor_{len(visitors) + 1}", (place,))
        world.check_room(*place, visitor.radius)
        world.add_person(visitor)
        visitors.append(visitor.name)
        return visitor.name

    def fault(name: Text, on: bool) -> None:
        if on:
            _refuse(world.faults.begin(name))
        else:
            world.faults.end(name)

    def move_robot(robot: Text, x: FiniteNumber, y: FiniteNumber, yaw: FiniteNumber | None = None) -> None:
        world.place(robot, x, y, yaw)

    def battery(robot: Text, level: FiniteNumber) -> None:
        world.set_battery(robot, level)

    found: list[Command] = [obstacle, person]
    found += [move_robot, battery] if world.robots else []
    found += [door] if world.doors else []
    found += [fault] if world.faults.by_name else []

    def shown(command: Command) -> Command:
        @wraps(command)
        def change(**values: Any) -> Any:
            system.ros.catch_up()  # the change happens now, not before the due steps of the world
            result = command(**values)
            show()  # even while the run is paused
            return result

        return change

    return {command.__name__: shown(command) for command in found}


def _place(x: float | None, y: float | None) -> tuple[float, float]:
    if x is None or y is None:
        raise Refused("`x` and `y` must be numbers")
    return x, y


def _refuse(why: str | None) -> None:
    if why is not None:
        raise Refused(why)


# ---- artifacts


def artifact_commands(system: System) -> Mapping[str, Command]:
    """Return the commands that call operations of artifacts."""

    def environment() -> Environment:
        if system.environment is None:
            raise Refused("this run has no artifacts")
        return system.environment

    async def operate(session: Session, artifact: Text, text: Text) -> str:
        return await _operate(environment(), artifact, text, str(session.caller))

    return {"operate": operate}


async def _operate(environment: Environment, artifact: str, written: str, caller: str) -> str:
    """Call an operation such as ``moveForward(1)``, wait for its end, and return its results as text."""
    names = Variables()
    outputs: Outputs = []
    term: Any = bare(lower_value(parse_literal(written), names.__getitem__))
    name, *arguments = term if term.__class__ is tuple else (term,)
    values = tuple(to_value(each, outputs) for each in arguments)
    target = next(
        (each for _, each in all_artifacts(environment) if artifact in (each.path, each.name)), None
    )
    if target is None:
        raise Refused(f"unknown artifact: `{artifact[:80]}`")
    await call(environment, target, name.name, values, caller)
    results = ((name, _value_of(variable, outputs)) for name, variable in names.items())
    return ", ".join(f"{name} = {value}" for name, value in results)


def _value_of(variable: Var, outputs: Outputs) -> str:
    found = next((out for each, out in outputs if each is variable), None)
    return value_text(found.value) if found is not None and found.is_set else "_"
