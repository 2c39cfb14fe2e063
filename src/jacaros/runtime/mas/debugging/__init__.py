"""Debug a running system: pause, step, speed, breakpoints, and reload of changed programs."""

from jacaros.runtime.mas.debugging.debugger import Debugger, DebugState

__all__ = ["DebugState", "Debugger"]
