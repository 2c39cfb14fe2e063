"""A debugging session: the requests of an editor about a run, and the events for it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from jacaros.agents.language.diagnostics import one_line
from jacaros.agents.language.offers import OPERATOR
from jacaros.agents.mind.mind import Mind
from jacaros.editors.dap.channel import Arguments, Body, Channel
from jacaros.editors.dap.points import FILTERS, Points
from jacaros.editors.dap.scopes import Scopes
from jacaros.editors.dap.threads import Threads
from jacaros.editors.dap.variables import Variables
from jacaros.runtime.clock import of_run
from jacaros.runtime.errors import JacarosError, UsageError
from jacaros.runtime.mas.console import line_of
from jacaros.runtime.mas.debugging.conditions import bindings_of
from jacaros.runtime.mas.debugging.debugger import DebugState, StepKind
from jacaros.runtime.mas.system import System
from jacaros.serving.callers import Caller
from jacaros.serving.questions import ask
from jacaros.serving.service import service_of

ENTRY = "entry"
"""Why a run is paused that waits for the editor's breakpoints, or is to stop before its first step."""
CAPABILITIES: Mapping[str, Any] = {
    "supportsConfigurationDoneRequest": True,
    "supportsConditionalBreakpoints": True,
    "supportsHitConditionalBreakpoints": True,
    "supportsLogPoints": True,
    "supportsFunctionBreakpoints": True,
    "exceptionBreakpointFilters": FILTERS,
    "supportsExceptionInfoRequest": True,
    "supportsEvaluateForHovers": True,
    "supportsSteppingGranularity": True,
    "supportsTerminateRequest": True,
    "supportTerminateDebuggee": True,
}

_CATEGORIES = {"debug": "console", "info": "console"}


@dataclass(frozen=True)
class Settings:
    """What the editor wants of a session.

    Attributes:
        debug: stop at breakpoints; False only shows the output.
        stop_on_entry: stop before the first step.
        changes: let `evaluate` change the agents' beliefs and goals.
        launched: the run belongs to the session, and ends with it.
    """

    debug: bool = True
    stop_on_entry: bool = False
    changes: bool = False
    launched: bool = True

    @classmethod
    def of(cls, given: Arguments, launched: bool) -> "Settings":
        """Return the settings in the arguments of `launch` or `attach`."""
        wants = {name: given.get(name) is True for name in ("noDebug", "stopOnEntry", "allowChanges")}
        return cls(not wants["noDebug"], wants["stopOnEntry"], wants["allowChanges"], launched)


class Session:
    """Debugs a run for an editor. All methods belong to the loop of the run.

    Args:
        system: the run; already started.
        channel: sends messages to the editor.
        settings: what the editor wants.
    """

    def __init__(self, system: System, channel: Channel, settings: Settings) -> None:
        self._system, self._channel, self._settings = system, channel, settings
        self._debugger = system.debugger
        self._variables, self._threads = Variables(), Threads(system)
        self._scopes = Scopes(system, self._variables)
        self._points = Points(
            system, lambda each: channel.event("breakpoint", reason="changed", breakpoint=each)
        )
        self._paused = self._own_request = False
        self._cannot: tuple[str, ...] = ()
        self._service = service_of(system).open(Caller("editor", "dap", frozenset({OPERATOR})))
        self._ends = [self._debugger.listen(self._debugger_changed), self._points.end]
        if not settings.launched:  # otherwise, the editor has all output of the process
            self._ends += [
                system.listen_to_prints(lambda agent, text: channel.output(line_of(agent, text), "stdout")),
                system.listen_to_log(
                    lambda text, level: channel.output(f"{text}\n", _CATEGORIES.get(level, "stderr"))
                ),
            ]
        system.when_ended(self._run_ended)
        self._requests: dict[str, Callable[[Arguments], Body]] = {
            "setBreakpoints": self._set_breakpoints,
            "setFunctionBreakpoints": self._set_function_breakpoints,
            "setExceptionBreakpoints": self._set_exception_breakpoints,
            "configurationDone": lambda _: None,
            "threads": lambda _: {"threads": self._threads.all()},
            "stackTrace": self._stack_trace,
            "scopes": lambda given: {
                "scopes": self._scopes.of(self._threads.level(_number(given, "frameId")))
            },
            "variables": self._parts,
            "evaluate": self._evaluate,
            "exceptionInfo": self._exception_info,
            "continue": self._continue,
            "pause": lambda _: self._debugger.pause(),
            "next": lambda given: self._step("over", given),
            "stepIn": lambda given: self._step("step", given),
            "stepOut": lambda given: self._step("out", given),
            "jacaros/cycle": lambda given: self._step("cycle", given),
            "jacaros/reload": lambda _: {"lines": self._debugger.reload()},
        }

    # ---- the protocol

    def take(self, request: Arguments) -> None:
        """Execute a request of the editor, and answer it."""
        command = str(request.get("command"))
        given = request.get("arguments") or {}
        if command in ("terminate", "disconnect"):
            self._channel.respond(request)
            self.leave(command == "terminate" or given.get("terminateDebuggee", self._settings.launched))
            return
        if command not in self._requests:
            self._channel.refuse(request, f"unknown request: {command[:80]}")
            return
        self._own_request = True
        try:
            with of_run():  # what a request starts pauses with the run
                body = self._requests[command](given)
        except JacarosError as error:
            self._channel.refuse(request, one_line(error))
        except (AttributeError, KeyError, TypeError, ValueError) as error:
            self._channel.refuse(request, f"invalid arguments of {command}: {type(error).__name__}: {error}")
        else:
            self._channel.respond(request, body)
            if command == "configurationDone":
                self._begin_run()
        finally:
            self._own_request = False

    def begin(self) -> None:
        """Ask for breakpoints. A run that the editor has launched begins at `configurationDone`."""
        if self._settings.debug:
            self._system.keep_history()
        if self._settings.launched:
            self._debugger.pause(ENTRY)
        self._channel.event("initialized")

    def _begin_run(self) -> None:
        """Let the launched run begin, or stop it, now that the breakpoints are set."""
        if self._settings.stop_on_entry and self._settings.debug:
            self._debugger.pause(ENTRY)
            self._paused = True
            self._stopped(self._debugger.state)
        elif self._settings.launched:
            self._debugger.resume()

    def leave(self, end_run: bool) -> None:
        """End the session; and the run, which stops its robots, or let it continue without breakpoints."""
        if end_run:
            self._system.stop_system(0.0, 0)
            return
        self._close()
        self._points.clear()
        self._debugger.resume()

    def _close(self) -> None:
        for end in self._ends:
            end()
        self._service.close()

    def _run_ended(self, code: int) -> None:
        self._close()
        self._channel.event("exited", exitCode=code)
        self._channel.event("terminated")

    def _debugger_changed(self, state: DebugState) -> None:
        paused = state.state == "paused"
        if paused == self._paused:
            return
        self._paused = paused
        self._variables.forget()
        self._threads.forget()
        if not paused:
            if not self._own_request:  # such as on the live page
                self._channel.event("continued", threadId=self._threads.id(""), allThreadsContinued=True)
        elif state.why != ENTRY:
            self._stopped(state)

    def _stopped(self, state: DebugState) -> None:
        if state.cannot and state.cannot != self._cannot:
            self._cannot = state.cannot
            stopped = ["robots were commanded to stand still"] if self._system.options.real_graph else []
            lines = [*stopped, *(f"not paused: {each}" for each in state.cannot)]
            self._channel.output("".join(f"{each}\n" for each in lines), "important")
        failure, why = self._debugger.failure, state.why
        reason = "exception" if failure is not None else why if " " not in why else "breakpoint"
        self._channel.event(
            "stopped",
            reason=reason,
            description=f"Paused: {why}",
            threadId=self._threads.stopped(),
            allThreadsStopped=True,
            **({"text": failure.message.splitlines()[0]} if failure is not None else {}),
        )

    # ---- breakpoints

    def _set_breakpoints(self, given: Arguments) -> Body:
        wanted = given.get("breakpoints") or [] if self._settings.debug else []
        return {"breakpoints": self._points.set_lines(str(given["source"]["path"]), wanted)}

    def _set_function_breakpoints(self, given: Arguments) -> Body:
        names = [str(each["name"]) for each in given["breakpoints"]] if self._settings.debug else []
        return {"breakpoints": self._points.set_functions(names)}

    def _set_exception_breakpoints(self, given: Arguments) -> Body:
        options = [each["filterId"] for each in given.get("filterOptions") or ()]
        kinds = [*given.get("filters", ()), *options] if self._settings.debug else []
        return {"breakpoints": self._points.set_failures(map(str, kinds))}

    # ---- control

    def _continue(self, _: Arguments) -> Body:
        self._debugger.resume()
        return {"allThreadsContinued": True}

    def _step(self, what: StepKind, given: Arguments) -> Body:
        host, intention = self._threads.of(_number(given, "threadId"))
        if host.mind is None:
            raise UsageError(f"agent `{host.name}` is written in Python; step another agent, or continue")
        if given.get("granularity") == "instruction":
            what = "cycle"
        elif intention is None and what != "cycle":
            what = "step"
        self._debugger.step(what, host.name, None if what == "cycle" else intention)
        return None

    # ---- the state

    def _stack_trace(self, given: Arguments) -> Body:
        frames = self._threads.stack(_number(given, "threadId"))
        return {"stackFrames": _page(frames, given, "startFrame", "levels"), "totalFrames": len(frames)}

    def _parts(self, given: Arguments) -> Body:
        found = self._variables.parts(_number(given, "variablesReference"))
        return {"variables": _page(found, given, "start", "count")}

    def _evaluate(self, given: Arguments) -> Body:
        """Answer a question to the agent of a stack frame, or that the run stopped for; or show a binding of the frame."""
        written, frame_id = str(given["expression"]).strip(), given.get("frameId")
        level = None if frame_id is None else self._threads.level(int(frame_id))
        host = self._threads.of(self._threads.stopped())[0] if level is None else level.host
        bindings = {} if level is None or level.frame is None else bindings_of(level.frame)
        if (alone := written.removeprefix("?")) in bindings:
            written = alone
            shown = self._variables.term(written, bindings[written])
            return {"result": shown["value"]} | {key: shown[key] for key in ("type", "variablesReference")}
        if written.startswith(("!", "+", "-")) and given.get("context") == "repl":
            if not self._settings.changes:
                raise UsageError("this session is read-only; set `allowChanges` to change beliefs and goals")
            answer = self._service.console(host.name, written)
        elif isinstance(host.mind, Mind):
            answer = ask(host.mind, written.removeprefix("?").removesuffix("."), bindings)
        else:
            raise UsageError(f"agent `{host.name}` is written in Python: it has no beliefs to ask for")
        return {"result": answer, "variablesReference": 0}

    def _exception_info(self, _: Arguments) -> Body:
        failure = self._debugger.failure
        if failure is None:
            raise UsageError("the run is not paused at a failure")
        first, *more = failure.message.splitlines()
        details = {"message": first, "typeName": failure.error, "stackTrace": "\n".join(more)}
        return {
            "exceptionId": failure.error,
            "description": first,
            "breakMode": "always",
            "details": details,
        }


def _page(found: list[dict[str, Any]], given: Arguments, start: str, count: str) -> list[dict[str, Any]]:
    """Return the part of a list that the editor wants: all of it unless it says a number."""
    first = int(given.get(start) or 0)
    return found[first : first + (int(given.get(count) or 0) or len(found))]


def _number(given: Arguments, name: str) -> int:
    value = given[name]
    if not isinstance(value, int):
        raise TypeError(f"`{name}` is not a number")
    return value
