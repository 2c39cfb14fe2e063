"""The operations of one artifact, step by step: begin, commit or roll back, end, cancel, dispose.

A step is the part of an operation between two step boundaries. It is published or rolled back as a whole.

This module does not depend on what an artifact looks like to its author (`Artifact`) or on its workspace (`Workspace`).
"""

import asyncio
import inspect
import threading
from collections.abc import Awaitable, Callable, Iterable
from dataclasses import dataclass, field
from functools import partial
from typing import Any, TypeVar

from jacaros.artifacts.env.arbiter import read_uses, scoped
from jacaros.artifacts.env.errors import ArtifactId, InvalidArtifact, OperationFailed
from jacaros.artifacts.env.execution import Holding, OperationExecution
from jacaros.artifacts.env.operation import (
    LINK,
    SUCCEEDED,
    OperationOutcome,
    OperationRequest,
    ignore_outcome,
)
from jacaros.artifacts.env.property import Signal, check_name
from jacaros.artifacts.env.values import Atom, Structure, plain
from jacaros.artifacts.kernel import faults
from jacaros.artifacts.kernel.declaration import ArgumentMismatch, DeclaredOperation, UsageInterface
from jacaros.artifacts.kernel.faults import is_interruption
from jacaros.artifacts.kernel.publication import Publication, Setting
from jacaros.artifacts.kernel.turns import Guard, TurnQueue
from jacaros.runtime.clock import Clock
from jacaros.runtime.errors import InternalError
from jacaros.runtime.trace import CURRENT, Cause

# Release what an artifact holds, when the last of its operations has ended.


@dataclass(slots=True)
class Ending:
    """The callbacks for the end of one artifact, called once.

    Attributes:
        hook: called first, if the artifact was initialised.
        cleanups: called after that, the last one first.
        over: whether all have been called.
    """

    hook: Callable[[], object] | None = None
    cleanups: list[Callable[[], object]] = field(default_factory=list)
    over: bool = False
    _over: "asyncio.Future[None] | None" = None

    def run(self, initialised: bool, complain: Callable[[str, BaseException], None]) -> None:
        """Call all callbacks. *complain* gets the exceptions they raise."""
        if self.over:
            return
        self.over = True
        hooks = (self.hook,) if self.hook is not None and initialised else ()
        for callback in (*hooks, *reversed(self.cleanups)):
            try:
                callback()
            except BaseException as error:
                if is_interruption(error):
                    raise
                complain("error while disposing:", error)
        if self._over is not None and not self._over.done():
            self._over.set_result(None)

    async def over_with(self) -> None:
        """Wait for the end."""
        if not self.over:
            if self._over is None:
                self._over = asyncio.get_running_loop().create_future()
            await asyncio.shield(self._over)  # cancelling one waiting task must not cancel the others


T = TypeVar("T")
V = TypeVar("V")
TELLING = "tell"
"""Name of the operation in messages about invalid values from sensors."""
PATIENCE = 20.0
"""Seconds in which the operations of a disposed artifact must end, as in CArtAgO."""


class Steps:
    """Runs the operations of one artifact.

    Attributes:
        id: identity of the artifact.
        artifact: the artifact itself.
        setting: what it shares with other artifacts.
        clock: clock of its operations.
        publication: its observable side.
        turns: the queue for its turn.
        disposed: whether it accepts no more operations.
        interface: its operations. Its own copy once it has defined operations itself.
        ports: names of its out ports.
        initialised: whether ``init`` has succeeded.
        abandon: called if the creation of the artifact was cancelled.
        ending: callbacks for when the last of its operations has ended.
    """

    def __init__(
        self,
        artifact_id: ArtifactId,
        artifact: Any,
        interface: UsageInterface,
        ports: tuple[str, ...],
        setting: Setting,
    ) -> None:
        self.id, self.setting = artifact_id, setting
        self.clock: Clock = setting.clock
        self.publication = Publication(artifact_id, setting)
        self.turns = TurnQueue(self._begin)
        self.disposed = False
        self._started: list[OperationExecution] = []
        self.artifact = artifact
        self.interface, self.ports = interface, ports
        self.initialised = False
        self.ending = Ending()
        self.abandon: Callable[[], object] = self.dispose
        self._running: dict[OperationExecution, None] = {}
        self._teller = OperationExecution(self, OperationRequest(artifact_id, TELLING, (), None))

    # ---- the step in progress

    def inside(self) -> bool:
        """Return whether the caller is the operation that has the turn, or its guard."""
        holder = self.turns.holder
        if holder is None or holder.task is None or self.turns.asking:
            return holder is not None
        try:
            return asyncio.current_task() is holder.task
        except RuntimeError:
            return False

    def current(self, wanted: str, name: str = "", changes: bool = True) -> OperationExecution:
        """Return the operation whose step is in progress.

        Args:
            wanted: what the caller is about to do, for messages.
            name: the name it concerns.
            changes: whether this changes anything, which a guard must not.

        Raises:
            InvalidArtifact: the caller is not within a step, for example in a callback, or is a guard.
        """
        if changes and self.turns.asking:
            raise InvalidArtifact(
                f"artifact {self.id.name}: {wanted} {name} is not possible within a guard, which must not change anything"
            )
        holder = self.turns.holder
        if holder is not None and self.inside():
            return holder
        raise InvalidArtifact(
            f"artifact {self.id.name}: {wanted} {name} is only possible within an operation; from a callback, "
            "another task or a thread, run an internal operation with self.start(...)"
        )

    def commit(self) -> None:
        """Publish the changes of the step so far. Operations that it started may begin."""
        if self.publication.properties.changing:
            holder = self.turns.holder
            self.publication.publish(holder.cause if holder is not None else None)
        if self._started:
            started, self._started = self._started, []
            if not self.disposed:
                for each in started:
                    self._claim(each)
                self.turns.line_up([each for each in started if not each.ended], self._guard)

    def _roll_back(self) -> None:
        """Undo what the step has changed and started since the last commit."""
        self.publication.properties.roll_back()
        self._started.clear()

    def signal(self, name: str, arguments: tuple[object, ...], addressee: str | None) -> None:
        """Send a signal, together with the changes of the step so far."""
        holder = self.current("the signal", name)
        check_name(name)
        signal = Signal(name, tuple(map(plain, arguments)))
        self.publication.publish(holder.cause, (signal,), addressee)
        self.commit()

    def boundary(self, wanted: str) -> OperationExecution:
        """End the step of the calling coroutine, which still has the turn."""
        execution = self.current(wanted)
        if execution.task is None:
            raise InvalidArtifact(f"artifact {self.id.name}: {wanted} is only possible in an async def")
        self.commit()
        return execution

    async def leave(self, awaitable: Awaitable[T], wanted: str) -> T:
        """Await something while others may have the turn: end one step and begin another."""
        try:
            execution = self.boundary(wanted)
        except InvalidArtifact:
            if inspect.iscoroutine(awaitable):
                awaitable.close()
            raise
        self.turns.release()
        try:
            result = await awaitable
        except GeneratorExit:
            raise
        except BaseException:
            await self.turns.retake(execution)
            raise
        await self.turns.retake(execution)
        return result

    async def until(self, guard: Guard) -> None:
        """Continue as soon as *guard* is true. It is evaluated now and after every step."""
        execution = self.boundary("waiting for a condition")
        if not callable(guard):
            raise InvalidArtifact(
                f"artifact {self.id.name}: expected a function in until, such as a method or lambda: ..., found {guard!r}"
            )
        if not self.turns.ask(guard):
            if self.disposed:
                # Nothing else can make it true: only the operation that disposed its own artifact continues.
                raise faults.disposed(execution.request).failure
            await self.turns.release_until(execution, guard)

    async def pause_point(self, on_pause: Callable[[], None] | None) -> float:
        """Wait while the operation is paused. Return the seconds that it has been paused since the last call."""
        execution = self.current("a pause point")
        while execution.paused:
            if on_pause is not None:
                on_pause()
            await self.leave(execution.resumed(), "a pause")
        return execution.take_paused_time()

    # ---- operations arrive

    def execute(self, request: OperationRequest, kind: str) -> OperationExecution:
        """Run an operation of *kind*. A plain ``def`` of a free artifact has ended when this returns."""
        table, arguments = self.interface.operations, request.arguments
        if kind == LINK:
            table = self.interface.links
        count = len(arguments)
        declared = table.exact.get((request.operation, count)) or table.find(request.operation, count)
        if declared is None:
            return self.refuse(request, faults.unknown_operation(request, kind, self.interface))
        if count:
            try:
                arguments = declared.signature.bind(arguments)
            except ArgumentMismatch as wrong:
                return self.refuse(request, faults.wrong_arguments(request, wrong))
        cause = request.cause
        if self.setting.tracer is not None:
            what = f"{self.id.path} {request.key}"
            cause = self.setting.trace("operation", what, cause, request)
        execution = OperationExecution(self, request, declared, arguments, cause)
        if self.setting.listener is not None:
            self.setting.listener.began(execution)
        if declared.uses or declared.guard is not None:
            self._arrive(execution, declared)
        else:
            self.turns.enter(execution, None)
        if request.timeout is not None and not execution.ended:
            execution.limit = self.clock.call_later(request.timeout, partial(self._time_is_up, execution))
        return execution

    def refuse(self, request: OperationRequest, outcome: OperationOutcome) -> OperationExecution:
        """Fail a request immediately."""
        refused = OperationExecution(self, request)
        self._tell(refused, outcome)
        return refused

    def start(self, declared: DeclaredOperation, request: OperationRequest) -> OperationExecution | None:
        """Start an internal operation. Return None if it is started elsewhere, or not at all.

        From within a step it begins after that step, and not at all if the step is rolled back. From outside, such as
        from a callback, it begins as soon as the artifact is free.
        """
        inside = self.inside()
        if not inside and self.setting.elsewhere():
            self.setting.call_on_loop(partial(self.start, declared, request))
            return None
        if request.cause is None and inside and self.turns.holder is not None:
            request.cause = self.turns.holder.cause
        execution = OperationExecution(self, request, declared, request.arguments, request.cause)
        if inside:
            self._started.append(execution)
        elif self.disposed:
            return None
        else:
            self._arrive(execution, declared)
        return execution

    def _arrive(self, execution: OperationExecution, declared: DeclaredOperation) -> None:
        """Begin an operation when it has its resources and its turn, and its guard is true, possibly immediately."""
        if declared.uses:
            self._claim(execution)
        if not execution.ended:
            self.turns.enter(execution, None if declared.guard is None else self._guard(execution))

    def tell(
        self, show: Callable[[str, V], None], told: Iterable[tuple[str, V]], cause: Cause | None
    ) -> bool:
        """Make a step that only changes properties. Return False, without any change, if that is not possible now.

        This is the path of sensor messages, the most frequent one, so it creates no operation. It is not possible while
        an operation has the turn or waits for it, or from another thread.

        Args:
            show: a plain function that assigns new values to the property with a name.
            told: names and values.
            cause: what led to it.
        """
        turns = self.turns
        if turns.holder is not None or turns.places or turns.serving or self.disposed:
            return False
        if self.setting.thread and self.setting.thread != threading.get_ident():
            return False
        teller = self._teller
        teller.cause, turns.holder = cause, teller
        try:
            for name, values in told:
                show(name, values)
            self.publication.publish(cause)
        except Exception as error:
            self._roll_back()
            self._note(teller, error)
            if isinstance(error, InternalError):
                self.setting.report(error)
        finally:
            if self._started:
                self.commit()
            turns.holder = None
            if turns.places:
                turns.reconsider()
        return True

    def initialise(self, declared: DeclaredOperation, request: OperationRequest) -> OperationExecution:
        """Run the ``init`` of the artifact as its first operation. The number of arguments is right."""
        self.setting.know_loop()
        try:
            arguments = declared.signature.bind(request.arguments)
        except ArgumentMismatch as wrong:
            return self.refuse(request, faults.wrong_arguments(request, wrong))
        execution = OperationExecution(self, request, declared, arguments, request.cause)
        self.turns.enter(execution, None)
        return execution

    # ---- resources of operations

    def used(self) -> tuple[str, ...]:
        """Return the resources that the operations of the artifact use, with the name of its robot."""
        tables = (self.interface.operations, self.interface.links)
        declared = [use for table in tables for each in table for use in each.uses]
        declared += read_uses(getattr(self.artifact, "further_uses", ()))
        return self._of_robot(tuple(dict.fromkeys(declared)))

    @property
    def robot(self) -> str:
        """Prefix of the robot that the artifact belongs to. Empty for the only one."""
        scope = getattr(self.artifact, "robot_prefix", "")
        return scope if isinstance(scope, str) else ""

    def _of_robot(self, uses: tuple[str, ...]) -> tuple[str, ...]:
        return scoped(uses, self.robot)

    def hold(self, execution: OperationExecution, uses: tuple[str, ...]) -> Holding:
        """Return a claim that an operation enters and leaves itself."""
        mode = execution.declared.when_preempted
        stop = partial(self._lose, execution)
        execution.holding = Holding(execution, self.setting.arbiter, self._of_robot(uses), mode, stop)
        return execution.holding

    def _claim(self, execution: OperationExecution) -> None:
        """Claim the resources of an operation, which begins when they are granted."""
        if execution.declared.uses:
            self.hold(execution, execution.declared.uses).enter()

    def _lose(self, execution: OperationExecution, reason: Structure | Atom) -> None:
        """Fail an operation that cannot have a resource, or has lost it."""
        message = faults.without_resource(execution.request, reason)
        outcome = OperationOutcome(False, message, reason)
        if execution.active or execution in self.turns.waiting_to_begin():
            self.stop(execution, outcome)
        elif not execution.ended:
            execution.verdict = outcome
            self._tell(execution, outcome)

    def _guard(self, execution: OperationExecution) -> Guard | None:
        guard = execution.declared.guard
        return None if guard is None else partial(guard, self.artifact, *execution.arguments)

    # ---- operations begin and end

    def _begin(self, execution: OperationExecution, error: BaseException | None) -> None:
        declared = execution.declared
        execution.begun = not declared.coroutine
        if error is not None:
            self.end(execution, error)
            return
        if declared.coroutine:
            name = f"{self.id.path} {execution.request.key}"
            self.setting.know_loop()
            execution.task = asyncio.get_running_loop().create_task(self._drive(execution), name=name)
            self._running[execution] = None
            return
        before = None if self.setting.tracer is None else CURRENT.set(execution.cause)
        try:
            result = declared.function(self.artifact, *execution.arguments)
            if result is not None:
                self._refuse_result(declared, result)
        except Exception as error:
            self.end(execution, error)
        except BaseException as error:
            if is_interruption(error):
                self.end(execution, OperationFailed("the process was interrupted"))
                raise
            self.end(execution, error)
        else:
            self.end(execution, None)
        finally:
            if before is not None:
                CURRENT.reset(before)

    async def _drive(self, execution: OperationExecution) -> None:
        error: BaseException | None = None
        cancellation: asyncio.CancelledError | None = None
        if self.setting.tracer is not None:
            CURRENT.set(execution.cause)  # in the task of the operation alone
        try:
            if not execution.stopped:
                execution.begun = True
                result = await execution.declared.function(self.artifact, *execution.arguments)
                if result is not None:
                    self._refuse_result(execution.declared, result)
        except asyncio.CancelledError as cancelled:
            cancellation = cancelled
            task = asyncio.current_task()
            if not execution.stopped and task is not None and not task.cancelling():
                error = cancelled
        except GeneratorExit as raised:
            if _is_abandoned(execution):
                raise
            error = raised
        except BaseException as raised:
            if is_interruption(raised):
                self.end(execution, OperationFailed("the process was interrupted"))
                raise
            error = raised
        if cancellation is not None and error is None and not execution.stopped:
            execution.cancelled = True
            self.end(execution, None)
            raise cancellation
        self.end(execution, error)

    def _refuse_result(self, declared: DeclaredOperation, result: object) -> None:
        """Report an operation whose return value is lost."""
        name = declared.function.__qualname__
        if inspect.iscoroutine(result):
            result.close()
            raise InvalidArtifact(f"{name} returned a coroutine; write async def")
        if declared not in self.setting.told:
            self.setting.told.add(declared)
            self.setting.log(
                f"[{self.id.name}] the return value of {name} is lost: return results in parameters annotated Out, as in "
                "`def ask(self, answer: Out)` with `answer.set(3)`"
            )

    def end(self, execution: OperationExecution, error: BaseException | None) -> None:
        """End the operation, and with it its last step."""
        if error is None:
            if self.publication.properties.changing or self._started:
                self.commit()
            outcome = SUCCEEDED
        else:
            self._roll_back()
            outcome = faults.failed(execution.request, error)
            self._note(execution, error)
        if execution.verdict is not None:
            outcome = execution.verdict
        if execution.task is not None:
            self._running.pop(execution, None)
        try:
            self.turns.end(self._tell, execution, outcome)
        finally:
            if self.disposed:
                self._close_if_over()
        if error is not None and isinstance(error, InternalError):
            self.setting.report(error)

    def _tell(self, execution: OperationExecution, outcome: OperationOutcome) -> None:
        if execution.ended:
            return  # it was abandoned
        execution.ended = True
        if execution.holding is not None:
            execution.holding.leave()
        if self.setting.listener is not None:
            self.setting.listener.ended(execution, None if execution.cancelled else outcome)
        if execution.limit is not None:
            execution.limit.cancel()
        if execution.cancelled:
            if not self.initialised and not self.disposed:
                self.abandon()
        else:
            try:
                execution.request.on_done(outcome)
            except Exception as error:
                self.setting.report(error)

    def _note(self, execution: OperationExecution, error: BaseException) -> None:
        """Log an error that is not reported elsewhere, or that its author must see."""
        key = execution.request.key
        if isinstance(error, InternalError):
            return
        if not isinstance(error, OperationFailed):
            self.setting.log_error(self.id.name, f"error in operation {key}; its step is rolled back:", error)
        elif execution.request.on_done is ignore_outcome or execution.stopped:
            self.setting.log(f"[{self.id.name}] operation {key} failed: {error.message}")

    # ---- operations leave

    def reconsider(self) -> None:
        """Check whether a waiting operation can continue."""
        self.turns.reconsider()

    def pending(self) -> tuple[OperationExecution, ...]:
        """Return the operations that run or wait, in no particular order."""
        return (*self._running, *self.turns.waiting_to_begin())

    def complain(self, what: str, error: BaseException) -> None:
        """Log an error of the artifact's code that does not fail an operation."""
        self.setting.log_error(self.id.name, what, error)

    def cancel(self, execution: OperationExecution) -> None:
        """End *execution* without an outcome. See `OperationExecution.cancel`."""
        if execution.ended or execution.stopped:
            return
        execution.cancelled = True
        if execution.task is not None:
            self._interrupt(execution)
        elif self.turns.withdraw(execution):
            self._tell(execution, SUCCEEDED)  # only a listener hears of it: it was cancelled

    def _interrupt(self, execution: OperationExecution) -> None:
        task = execution.task
        if task is None or not execution.begun:
            return
        if asyncio.current_task() is not task and self.turns.holder is execution:
            self._roll_back()
        task.cancel()

    def publish_last(self) -> None:
        """Publish the changes of an operation that is about to dispose its own artifact, while it still exists."""
        if not self.disposed and self.turns.holder is not None and self.inside():
            self.disposed = True  # operations that the step started must not begin
            self.commit()

    def dispose(self) -> None:
        """Refuse new operations, remove the observers, and end all operations.

        Only the operation that disposes its own artifact continues. All others fail.
        """
        self.disposed = True
        survivor = self.turns.holder if self.inside() else None
        self.publication.close()
        for execution in (*self.turns.waiting_to_begin(), *self._running):
            if execution is not survivor and not execution.stopped:
                self.stop(execution, faults.disposed(execution.request))
        self._close_if_over()

    def _time_is_up(self, execution: OperationExecution) -> None:
        seconds = execution.request.timeout
        if seconds is not None and not execution.ended and not execution.stopped:
            self.stop(execution, faults.timed_out(execution.request, seconds))

    def stop(self, execution: OperationExecution, outcome: OperationOutcome) -> None:
        """End an operation from outside. Its caller gets *outcome* when it has ended."""
        execution.verdict = outcome
        if self.turns.withdraw(execution):
            self._tell(execution, outcome)
        else:
            self._interrupt(execution)

    async def closed(self) -> None:
        """Wait until the disposed artifact has released everything. Operations that do not end in time are abandoned."""
        if self.ending.over:
            return
        limit = self.clock.call_later(PATIENCE, self._leave_behind)
        try:
            await self.ending.over_with()
        finally:
            limit.cancel()

    def _leave_behind(self) -> None:
        for execution in tuple(self._running):
            told = (
                f"operation {execution.request.key} did not stop within {PATIENCE:g} s of its artifact's disposal; "
                "abandoning it"
            )
            self.setting.log(f"[{self.id.name}] {told}")
            self._tell(execution, faults.disposed(execution.request))
            if execution.task is not None:
                self._abandon_task(execution.task)
        self._running.clear()
        self.ending.run(self.initialised, self.complain)

    def _abandon_task(self, task: "asyncio.Task[None]") -> None:
        """End a task that ignores its cancellation. Otherwise the end of the event loop would wait for it forever."""
        try:
            task.get_coro().close()
        except BaseException as error:
            if is_interruption(error):
                raise
            self.complain("an abandoned operation is still running:", error)
            return
        task.add_done_callback(lambda over: over.cancelled() or over.exception())
        task.cancel()

    def _close_if_over(self) -> None:
        if self.disposed and not self._running and self.turns.holder is None:
            self.ending.run(self.initialised, self.complain)


def _is_abandoned(execution: OperationExecution) -> bool:
    """Return whether the coroutine of *execution* is closed with the event loop, and does not run again."""
    try:
        return asyncio.current_task() is not execution.task
    except RuntimeError:
        return True
