"""Debug a running system: pause, step, speed, breakpoints, and reload of changed programs."""

from jacaros.runtime.mas.debugging.breakpoints import Breakpoint
from jacaros.runtime.mas.debugging.debugger import Debugger, DebugState, StepKind

__all__ = ["Breakpoint", "DebugState", "Debugger", "StepKind"]
