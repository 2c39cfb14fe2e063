"""The operations of one artifact, step by step: begin, commit or roll back, end, cancel, dispose.

A step is a stretch of an operation between two step boundaries: it is published or undone as a whole.
Nothing here knows what an artifact looks like to its author (`Artifact`) or where it lives (`Workspace`).
"""

import asyncio
import inspect
import threading
from collections.abc import Awaitable, Callable
from functools import partial
from typing import TypeVar

from jacaros.clock import Clock
from jacaros.env.errors import InvalidArtifact, OperationFailed
from jacaros.env.execution import OperationExecution
from jacaros.env.ids import ArtifactId
from jacaros.env.kernel import outcomes
from jacaros.env.kernel.declaration import DeclaredOperation
from jacaros.env.kernel.faults import is_interruption
from jacaros.env.kernel.interface import Interface
from jacaros.env.kernel.publication import Publication
from jacaros.env.kernel.setting import Setting
from jacaros.env.kernel.signature import WrongArguments
from jacaros.env.kernel.threads import in_thread
from jacaros.env.kernel.turns import Guard, TurnQueue
from jacaros.env.observation import Signal
from jacaros.env.operation import (
    EXTERNAL,
    LINK,
    SUCCEEDED,
    OperationOutcome,
    OperationRequest,
    ignore_outcome,
)
from jacaros.env.property import check_name
from jacaros.env.values import plain
from jacaros.errors import InternalError

T = TypeVar("T")


class Steps:
    """Runs the operations of one artifact.

    Attributes:
        id: the artifact.
        clock: where its operations take time from.
        setting: its surroundings.
        interface: what it offers; its own copy once it has defined operations of its own.
        publication: its observable side.
        turns: whose turn it is.
        ports: names of its out ports.
        disposed: True when it takes no more operations.
        over: True when the last of them has ended and everything has been given back.
        initialised: True once ``init`` has succeeded.
        abandon: called when the making of the artifact was dropped.
        hook: called first when an initialised artifact ends.
        cleanups: called after that, the last one first.
    """

    def __init__(
        self,
        artifact_id: ArtifactId,
        artifact: object,
        interface: Interface,
        ports: tuple[str, ...],
        setting: Setting,
    ) -> None:
        self.id, self._artifact, self.setting = artifact_id, artifact, setting
        self.interface, self.ports = interface, ports
        self.clock: Clock = setting.clock
        self.publication = Publication(artifact_id, setting)
        self.turns = TurnQueue(self._begin)
        self.disposed = False
        self.initialised = False
        self.hook: Callable[[], object] | None = None
        self.cleanups: list[Callable[[], object]] = []
        self._closed: asyncio.Future[None] | None = None
        self.over = False
        self._running: dict[OperationExecution, None] = {}
        self.abandon: Callable[[], object] = self.dispose
        self._started: list[OperationExecution] = []
        self._delayed: list[tuple[Signal, str | None]] = []

    @property
    def artifact_type(self) -> type:
        """The class of the artifact."""
        return type(self._artifact)

    # ---- operations come

    def execute(self, request: OperationRequest, kind: str) -> OperationExecution:
        """Run an operation of *kind*: a plain ``def`` of a free artifact has ended when this returns."""
        table = self.interface.links if kind == LINK else self.interface.operations
        declared = table.find(request.operation, len(request.arguments))
        if declared is None:
            return self.refuse(request, outcomes.unknown_operation(request, kind, self.interface))
        try:
            arguments = declared.signature.bind(request.arguments)
        except WrongArguments as wrong:
            return self.refuse(request, outcomes.wrong_arguments(request, wrong))
        cause = request.cause
        if self.setting.tracer is not None:
            cause = self.setting.trace("operation", f"{self.id.path} {outcomes.key(request)}", cause)
        execution = OperationExecution(self, request, declared, arguments, cause)
        self.turns.enter(execution, None if declared.guard is None else self._guard(execution))
        if request.timeout is not None and not execution.ended:
            execution.limit = self.clock.call_later(request.timeout, partial(self._time_is_up, execution))
        return execution

    def refuse(self, request: OperationRequest, outcome: OperationOutcome) -> OperationExecution:
        """Tell at once that the request failed."""
        refused = OperationExecution(None, request)
        self._tell(refused, outcome)
        return refused

    def start(self, declared: DeclaredOperation, request: OperationRequest) -> None:
        """Start an operation of the artifact's own.

        From within a step it begins after that step, and not at all when the step is rolled back; from
        outside, such as from a callback, as soon as the artifact is free.
        """
        inside = self.inside()
        if not inside and self.setting.elsewhere():
            self.setting.hand_over(partial(self.start, declared, request))
            return
        if request.cause is None and inside and self.turns.holder is not None:
            request.cause = self.turns.holder.cause
        execution = OperationExecution(self, request, declared, request.arguments, request.cause)
        if inside:
            self._started.append(execution)
        elif not self.disposed:
            self.turns.enter(execution, self._guard(execution))

    def initialise(self, declared: DeclaredOperation, request: OperationRequest) -> OperationExecution:
        """Run the ``init`` of the artifact as its first operation; the number of arguments is right."""
        self.setting.know_loop()
        try:
            arguments = declared.signature.bind(request.arguments)
        except WrongArguments as wrong:
            return self.refuse(request, outcomes.wrong_arguments(request, wrong))
        execution = OperationExecution(self, request, declared, arguments, request.cause)
        self.turns.enter(execution, None)
        return execution

    async def enter_task(self, execution: OperationExecution) -> None:
        """Give the running task, which is not one of ours, the turn.

        Raises:
            OperationFailed: the artifact was disposed meanwhile.
        """
        execution.task, execution.begun = asyncio.current_task(), True
        self._running[execution] = None
        try:
            await self.turns.retake(execution)
        except BaseException as error:
            self.leave_task(execution, error)
            raise
        if execution.verdict is not None:
            self.leave_task(execution, None)
            raise OperationFailed(execution.verdict.message or "", execution.verdict.reason)

    def leave_task(self, execution: OperationExecution, error: BaseException | None) -> None:
        """End what `enter_task` began; with an *error* it is undone."""
        self._end(execution, error)

    def _guard(self, execution: OperationExecution) -> Guard | None:
        declared = execution.declared
        if declared is None or declared.guard is None:
            return None
        return partial(declared.guard, self._artifact, *execution.arguments)

    # ---- operations begin and end

    def _begin(self, execution: OperationExecution, error: BaseException | None) -> None:
        declared = execution.declared
        assert declared is not None
        execution.begun = not declared.coroutine
        if error is not None:
            self._end(execution, error)
        elif not declared.coroutine:
            self._run(execution, declared)
        else:
            name = f"{self.id.path} {outcomes.key(execution.request)}"
            self.setting.know_loop()
            execution.task = asyncio.get_running_loop().create_task(self._drive(execution), name=name)
            self._running[execution] = None

    def _run(self, execution: OperationExecution, declared: DeclaredOperation) -> None:
        try:
            result = declared.function(self._artifact, *execution.arguments)
            if result is not None and inspect.iscoroutine(result):
                result.close()
                raise InvalidArtifact(f"{declared.function.__qualname__} gave a coroutine: write async def")
        except Exception as error:
            self._end(execution, error)
        except BaseException as error:
            if is_interruption(error):
                self._end(execution, OperationFailed("the process was interrupted"))
                raise
            self._end(execution, error)
        else:
            self._end(execution, None)

    async def _drive(self, execution: OperationExecution) -> None:
        error: BaseException | None = None
        cancellation: asyncio.CancelledError | None = None
        try:
            if not execution.stopped:
                execution.begun = True
                error = await self._call(execution)
        except asyncio.CancelledError as cancelled:
            cancellation = cancelled
            task = asyncio.current_task()
            if not execution.stopped and task is not None and not task.cancelling():
                error = cancelled
        except GeneratorExit as raised:
            if _thrown_away(execution):
                raise
            error = raised
        except BaseException as raised:
            if is_interruption(raised):
                self._end(execution, OperationFailed("the process was interrupted"))
                raise
            error = raised
        if cancellation is not None and error is None and not execution.stopped:
            execution.cancelled = True
            self._end(execution, None)
            raise cancellation
        self._end(execution, error)

    async def _call(self, execution: OperationExecution) -> BaseException | None:
        """Run the code of a coroutine, or of a thread; what a thread raised is given, not raised."""
        declared = execution.declared
        assert declared is not None
        if not declared.threaded:
            await declared.function(self._artifact, *execution.arguments)
            return None
        self.publication.freeze()
        try:
            if declared.kind == EXTERNAL:
                raised: BaseException | None = await declared.function(execution)
                return raised
            work = partial(
                in_thread, execution, partial(declared.function, self._artifact, *execution.arguments)
            )
            return await asyncio.get_running_loop().run_in_executor(None, work)
        finally:
            self.publication.thaw()

    def _end(self, execution: OperationExecution, error: BaseException | None) -> None:
        """End the operation, and with it its last step."""
        if error is None:
            if self.publication.properties.changing or self._started or self._delayed:
                self.commit()
            outcome = SUCCEEDED
        else:
            self._roll_back()
            outcome = outcomes.failed(execution.request, error)
            self._note(execution, error)
        if execution.verdict is not None:
            outcome = execution.verdict
        if execution.task is not None:
            del self._running[execution]
        try:
            self.turns.end(self._tell, execution, outcome)
        finally:
            if self.disposed:
                self._close_if_over()
        if error is not None and isinstance(error, InternalError):
            self.setting.report(error)

    def _tell(self, execution: OperationExecution, outcome: OperationOutcome) -> None:
        execution.ended = True
        if execution.limit is not None:
            execution.limit.cancel()
        if execution.cancelled:
            if not self.initialised and not self.disposed:
                self.abandon()
        elif not execution.told:
            self._inform(execution, outcome)

    def _inform(self, execution: OperationExecution, outcome: OperationOutcome) -> None:
        execution.told = True
        try:
            execution.request.on_done(outcome)
        except Exception as error:
            self.setting.report(error)

    def _note(self, execution: OperationExecution, error: BaseException) -> None:
        """Log what nobody else would see, or what its author must see."""
        key = outcomes.key(execution.request)
        if isinstance(error, InternalError) or execution.request.operation == EXTERNAL:
            return
        if not isinstance(error, OperationFailed):
            self.setting.log_error(self.id.name, f"error in operation {key}, its step is undone:", error)
        elif execution.request.on_done is ignore_outcome or execution.stopped:
            self.setting.log(f"[{self.id.name}] operation {key} failed: {error.message}")

    # ---- steps

    def inside(self) -> bool:
        """True when called by the operation that has the turn, or by its guard."""
        holder = self.turns.holder
        if holder is None or holder.task is None or self.turns.asking:
            return holder is not None
        if holder.thread is not None:
            return holder.thread == threading.get_ident()
        try:
            return asyncio.current_task() is holder.task
        except RuntimeError:
            return False

    def current(self, wanted: str, name: str = "", changes: bool = True) -> OperationExecution:
        """The operation that makes a step now.

        Args:
            wanted: what the caller is about to do, for the message.
            name: and to what.
            changes: whether that changes something, which a guard must not.

        Raises:
            InvalidArtifact: the caller is not within a step, such as in a callback, or is a guard.
        """
        if changes and self.turns.asking:
            raise InvalidArtifact(
                f"artifact {self.id.name}: {wanted} {name} is not possible within a guard; a guard only looks"
            )
        holder = self.turns.holder
        if holder is not None and self.inside():
            return holder
        raise InvalidArtifact(
            f"artifact {self.id.name}: {wanted} {name} is only possible within an operation; from a callback, "
            "another task or thread use self.start(...) to run an internal operation, or self.external_session()"
        )

    def commit(self) -> None:
        """Publish what the step has changed so far; operations that it started may begin."""
        if self._delayed:
            self._publish_delayed()
        if self.publication.properties.changing:
            holder = self.turns.holder
            self.publication.publish(holder.cause if holder is not None else None)
        if self._started:
            started, self._started = self._started, []
            if not self.disposed:
                self.turns.line_up(started, self._guard)

    def _publish_delayed(self) -> None:
        delayed, self._delayed = self._delayed, []
        holder = self.turns.holder
        cause = holder.cause if holder is not None else None
        self.publication.publish(cause, tuple(signal for signal, addressee in delayed if addressee is None))
        for signal, addressee in delayed:
            if addressee is not None:
                self.publication.publish(cause, (signal,), addressee)

    def _roll_back(self) -> None:
        """Undo what the step has changed, signalled (in a thread) and started since the last commit."""
        self.publication.properties.roll_back()
        self._started.clear()
        self._delayed.clear()

    def signal(self, name: str, arguments: tuple[object, ...], addressee: str | None) -> None:
        """Publish a signal, together with what the step has changed so far."""
        holder = self.current("the signal", name)
        check_name(name)
        signal = Signal(name, tuple(map(plain, arguments)))
        if holder.declared is not None and holder.declared.threaded:
            self._delayed.append((signal, addressee))
            return
        self.publication.publish(holder.cause, (signal,), addressee)
        self.commit()

    def boundary(self, wanted: str) -> OperationExecution:
        """End the step of the coroutine that calls this; it still has the turn."""
        execution = self.current(wanted)
        if execution.task is None:
            raise InvalidArtifact(
                f"artifact {self.id.name}: {wanted} needs an operation that is an async def"
            )
        self.commit()
        return execution

    async def leave(self, awaitable: Awaitable[T], wanted: str) -> T:
        """Await something while others have their turn: the end of one step and the beginning of another."""
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
        """Go on as soon as *guard* is true; it is evaluated now and whenever a step has ended."""
        execution = self.boundary("waiting for a condition")
        if not callable(guard):
            raise InvalidArtifact(
                f"artifact {self.id.name}: until wants a function, such as a method or lambda: ..., not {guard!r}"
            )
        if not self.turns.ask(guard):
            await self.turns.release_until(execution, guard)

    async def pause_point(self, on_pause: Callable[[], None] | None) -> float:
        """Wait while the operation is paused; gives the seconds that it has been paused since last asked."""
        execution = self.current("a pause point")
        while execution.paused:
            if on_pause is not None:
                on_pause()
            await self.leave(execution.resumed(), "a pause")
        return execution.take_paused_time()

    # ---- operations go

    def reconsider(self) -> None:
        """See whether somebody who waits may go on now."""
        self.turns.reconsider()

    def pending(self) -> tuple[OperationExecution, ...]:
        """The operations that run or wait, in no particular order of their ends."""
        return (*self._running, *self.turns.waiting_to_begin())

    def complain(self, what: str, error: BaseException) -> None:
        """Log an error of the artifact's code that harms nobody."""
        self.setting.log_error(self.id.name, what, error)

    def cancel(self, execution: OperationExecution) -> None:
        """End *execution* without an outcome; see `OperationExecution.cancel`."""
        if execution.ended or execution.stopped:
            return
        execution.cancelled = True
        if execution.task is not None:
            self._interrupt(execution)
        elif self.turns.withdraw(execution):
            execution.ended = True
            if execution.limit is not None:
                execution.limit.cancel()

    def _interrupt(self, execution: OperationExecution) -> None:
        task, declared = execution.task, execution.declared
        if task is None or declared is None or declared.threaded or not execution.begun:
            return
        if declared.kind == EXTERNAL:
            return  # the task is somebody else's
        if asyncio.current_task() is not task and self.turns.holder is execution:
            self._roll_back()
        task.cancel()

    def dispose(self) -> None:
        """Take no more operations, leave the observers, and end all operations.

        Only the operation that disposes its own artifact goes on; all others fail.
        """
        self.disposed = True
        survivor = self.turns.holder if self.inside() else None
        if survivor is not None:
            self.commit()
        self.publication.close()
        for execution in (*self.turns.waiting_to_begin(), *self._running):
            if execution is not survivor and not execution.stopped:
                self._stop(execution, outcomes.disposed(execution.request))
        self._close_if_over()

    def _time_is_up(self, execution: OperationExecution) -> None:
        seconds = execution.request.timeout
        if seconds is not None and not execution.ended and not execution.stopped:
            self._stop(execution, outcomes.timed_out(execution.request, seconds))

    def _stop(self, execution: OperationExecution, outcome: OperationOutcome) -> None:
        """End an operation from outside; its caller is told *outcome* when it has ended.

        Nobody can end a thread: its caller is told at once.
        """
        execution.verdict = outcome
        if self.turns.withdraw(execution):
            self._tell(execution, outcome)
        elif execution.declared is not None and execution.declared.threaded:
            self._inform(execution, outcome)
        else:
            self._interrupt(execution)

    async def closed(self) -> None:
        """Wait until the disposed artifact has given back everything."""
        if not self.over:
            if self._closed is None:
                self._closed = asyncio.get_running_loop().create_future()
            await asyncio.shield(self._closed)  # who stops waiting must not end the waiting of others

    def _close_if_over(self) -> None:
        if not self.disposed or self.over or self._running or self.turns.holder is not None:
            return
        self.over = True
        hooks = (self.hook,) if self.hook is not None and self.initialised else ()
        for callback in (*hooks, *reversed(self.cleanups)):
            try:
                callback()
            except BaseException as error:
                if is_interruption(error):
                    raise
                self.complain("could not be disposed properly:", error)
        if self._closed is not None and not self._closed.done():
            self._closed.set_result(None)


def _thrown_away(execution: OperationExecution) -> bool:
    """True when the coroutine of *execution* is closed with the loop, and does not run any more."""
    try:
        return asyncio.current_task() is not execution.task
    except RuntimeError:
        return True
