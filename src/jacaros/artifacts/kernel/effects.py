"""Operations that expect effects: watch the properties of a robot while one runs, and after it.

The expectations are checked around the operation's own function, so operations without any cost nothing.
"""

import asyncio
import inspect
from collections.abc import Callable, Mapping
from functools import partial, wraps
from typing import Any

from jacaros.artifacts.env.errors import OperationFailed
from jacaros.artifacts.env.expectation import Expect
from jacaros.artifacts.env.operation import OperationOutcome
from jacaros.artifacts.env.property import Observation
from jacaros.artifacts.env.values import Structure, text
from jacaros.runtime.clock import Timer


def expecting(
    function: Callable[..., Any],
    usual: Mapping[str, object],
    expect: tuple[Expect, ...],
    meanwhile: tuple[Expect, ...],
) -> Callable[..., Any]:
    """Return *function* as a coroutine that fails without the effects *expect*, and stops if *meanwhile* is violated.

    Args:
        function: takes the artifact and the arguments.
        usual: its parameters with their default values, for patterns that refer to them.
        expect: effects, after its end.
        meanwhile: conditions while it runs.
    """

    @wraps(function)
    async def run(artifact: Any, *arguments: object) -> object:
        given = {**usual, **dict(zip(usual, arguments, strict=False))}
        watch = _Watch(artifact, [each.bound(given) for each in expect])
        try:
            watch.begin([each.bound(given) for each in meanwhile])
            if artifact.current.stopped:
                await asyncio.sleep(0)  # where its cancellation arrives, before anything has moved
            result = function(artifact, *arguments)
            if inspect.iscoroutine(result):
                result = await result
            await watch.settle()
            return result
        finally:
            watch.close()

    return run


class _Watch:
    """Watches the artifacts of one robot for one operation. An observer that belongs to no agent."""

    agent = ""

    def __init__(self, artifact: Any, expect: list[Expect]) -> None:
        self._artifact, self._steps = artifact, artifact._steps
        self._execution = artifact.current
        self._what = f"operation {artifact.current.request.key} of artifact {artifact.id.name}"
        self._places = artifact.workspace.of_same_robot(artifact.id)
        self._expect, self._meanwhile, self._pending = expect, list[Expect](), list[Expect]()
        self._known = {each.name for each in expect if self._found(each)}
        self._timers: dict[Expect, Timer] = {}
        self._wake: asyncio.Future[None] | None = None
        self._failure: OperationFailed | None = None

    def _found(self, each: Expect) -> list[tuple[object, ...]]:
        named = (found.values for place in self._places for found in place.properties.all(each.name))
        return [values for values in named if len(values) == len(each.values)]

    def _holds(self, each: Expect) -> bool:
        return any(map(each.matches, self._found(each)))

    def _missed(self, each: Expect, what: str) -> OperationFailed:
        told, reason = each.missed(next(iter(self._found(each)), None))
        return OperationFailed(f"{self._what} {what}: {told}", reason)

    def _follow(self, on: bool = True) -> None:
        for place in self._places:
            place.follow(self, on)

    def close(self) -> None:
        """Watch no longer."""
        self._follow(False)
        self._meanwhile, self._pending = [], []
        for timer in self._timers.values():
            timer.cancel()
        self._timers.clear()

    # ---- while it runs

    def begin(self, meanwhile: list[Expect]) -> None:
        """Stop the operation when a condition is violated, possibly now."""
        if meanwhile:
            self._meanwhile = meanwhile
            self._follow()
            self._execution.on_resume(self._look)
            self._look()

    def observe(self, observation: Observation) -> None:
        """Look at the conditions, or the effects, after a change."""
        for signal in observation.signals:
            for each in self._meanwhile:
                if each.signal and signal.name == each.name and each.matches(signal.arguments):
                    here = Structure(signal.name, signal.arguments)
                    told = f"{self._what} was stopped by {text(here)}"
                    self._stop(OperationFailed(told, each.failure("occurred", here)))
        self._look()

    def _look(self) -> None:
        self._pending = [each for each in self._pending if not self._holds(each)]
        if not self._pending:
            self._wake_up()
        for each in self._meanwhile:
            if each.signal or not self._found(each) or self._holds(each):
                if (timer := self._timers.pop(each, None)) is not None:
                    timer.cancel()
            elif not each.within:
                self._stop(self._missed(each, "was stopped"))
            elif each not in self._timers:
                self._timers[each] = self._steps.clock.call_later(each.within, partial(self._run_out, each))

    def _run_out(self, each: Expect) -> None:
        del self._timers[each]
        self._stop(self._missed(each, "was stopped"))

    def _stop(self, failure: OperationFailed) -> None:
        if not (self._execution.paused or self._execution.stopped or self._execution.ended):
            self._steps.stop(self._execution, OperationOutcome.of(failure))

    # ---- when it has ended

    async def settle(self) -> None:
        """Wait until the effects show.

        Raises:
            OperationFailed: one has not shown in time.
        """
        self.close()
        self._places = self._artifact.workspace.of_same_robot(self._steps.id)  # some may have come or gone
        missing = [each for each in self._expect if not self._holds(each)]
        # The first message of a property may still come; one that never comes is waited for once.
        told = self._steps.setting.told
        self._pending = [each for each in missing if self._is_known(each) or self._key(each) not in told]
        if not self._pending:
            return
        for each in self._pending:
            self._timers[each] = self._steps.clock.call_later(each.within, partial(self._miss, each))
        self._follow()
        self._execution.on_pause(self._wake_up)
        while self._pending:
            await self._artifact.pause_point()  # a more urgent operation gets the resources
            self._wake = asyncio.get_running_loop().create_future()
            if self._pending and self._failure is None:
                await self._artifact.step(self._wake)
            if self._failure is not None:
                raise self._failure

    def _is_known(self, each: Expect) -> bool:
        return bool(self._found(each)) or each.name in self._known

    def _key(self, each: Expect) -> tuple[object, ...]:
        return self._steps.id, self._execution.request.operation, each.name

    def _miss(self, each: Expect) -> None:
        if each not in self._pending or self._failure is not None:
            return
        if self._is_known(each):
            self._failure = self._missed(each, "had no effect")
        else:
            self._steps.setting.told.add(self._key(each))
            self._artifact.log(
                f"warning: cannot check the effect of {self._execution.request.key}: no artifact of this robot shows "
                f"{each.name}/{len(each.values)}"
            )
            self._pending.remove(each)
        self._wake_up()

    def _wake_up(self) -> None:
        if self._wake is not None and not self._wake.done():
            self._wake.set_result(None)
