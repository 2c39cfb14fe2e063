"""Receiving messages: a thread with a wait set of our own, beside rclpy's executor.

For each message rclpy's executor iterates three times, in Python, over all entities of the node: events of publishers
and subscriptions, services, clients. Together with the switch between threads, that made an agent's reaction 50 %
slower than a plain callback. Here a wait costs a few calls per topic, and nothing else is checked.

All uses of rclpy's internals are in this file. Any release may change them: if one differs or is missing, rclpy's
executor takes over.
"""

import threading
from collections.abc import Callable, Mapping
from contextlib import ExitStack, suppress
from importlib import import_module
from typing import Any

from rclpy.callback_groups import CallbackGroup  # type: ignore[import-not-found]
from rclpy.guard_condition import GuardCondition  # type: ignore[import-not-found]


def _inner(name: str) -> Any:
    """Return an object of rclpy's extension module; None if it does not exist."""
    try:
        module = import_module("rclpy.impl.implementation_singleton")
        return getattr(module.rclpy_implementation, name, None)
    except (ImportError, AttributeError):
        return None


RCLError: type[Exception] = _inner("RCLError") or RuntimeError
"""Raised by rclpy when rcl refuses a call; a `RuntimeError` in all releases."""
InvalidHandle: type[Exception] = _inner("InvalidHandle") or RuntimeError
"""Raised by the handle of a destroyed entity."""


def wait_set(subscriptions: int, guards: int, events: int, context: Any) -> Any:
    """Make a wait set of rcl.

    Args:
        subscriptions, guards, events: number of each in the set.
        context: the handle of rclpy's context.

    Raises:
        NotImplementedError: rclpy has no wait sets.
    """
    made = _inner("WaitSet")
    if made is None:
        raise NotImplementedError("rclpy has no wait sets")
    return made(subscriptions, guards, 0, 0, 0, events, context)


Take = Callable[[Any], None]


class NotForExecutor(CallbackGroup):  # type: ignore[misc]
    """A group of subscriptions that rclpy's executor ignores, until they are returned to it."""

    given_back = False

    def add_entity(self, entity: Any) -> None:
        """Do nothing; rclpy's groups never forget their entities."""

    def can_execute(self, entity: Any) -> bool:
        """Return whether the executor may wait for *entity*."""
        return self.given_back

    def beginning_execution(self, entity: Any) -> bool:
        """Return whether the executor may call the callback of *entity*; it has one thread and asks for one at a
        time."""
        return self.given_back

    def ending_execution(self, entity: Any) -> None:
        """Do nothing."""


def take_message(handle: Any, kind: Any) -> Any:
    """Take a message of class *kind* with its metadata; None if another receiver has taken it."""
    return handle.take_message(kind, False)


def _received(arrived: tuple[Take, Any, Mapping[str, Any]]) -> int:
    """Return when a message reached this computer; 0 if the middleware does not say."""
    return arrived[2]["received_timestamp"] or 0


class Receiver:
    """Receives the messages of subscriptions that use the callback group `group`.

    Args:
        context: rclpy's context.
        report: called with one line about a fault; in the receiver's thread.
        executor: rclpy's, for everything else; it also gets the subscriptions if the receiver fails.
    """

    def __init__(self, context: Any, report: Callable[[str], None], executor: Any) -> None:
        self.group = NotForExecutor()
        self._context = context
        self._report = report
        self._wake_executor = executor.wake
        self._guard: Any = GuardCondition(None, None, context=context)
        self._lock = threading.Lock()
        self._takers: dict[Any, Take] = {}
        self._leaving: list[Callable[[], None]] = []
        self._changed = False
        self._stopped = False
        self._over = False
        self._reported: set[str] = set()
        self._thread = threading.Thread(target=self._run, name="ros2 receiver", daemon=True)
        self._thread.start()

    def add(self, subscription: Any, take: Take) -> None:
        """Call *take* with each message of *subscription*, in the receiver's thread; it must not block.

        Its events (deadline, quality of service) are handled in this thread, too: with Fast DDS, an executor that
        waits for them wakes up with each message, and then holds the interpreter when it is needed here.
        """
        # A subscription made by rclpy itself has another group so far.
        for entity in (subscription, *subscription.event_handlers):
            entity.callback_group = self.group
        with self._lock:
            self._takers[subscription] = take
            self._wake()

    def remove(self, subscription: Any, then: Callable[[], None]) -> None:
        """Release *subscription*, and call *then* when it is no longer waited for."""
        with self._lock:
            self._takers.pop(subscription, None)
            waited_for = not self._over
            if waited_for:
                self._leaving.append(then)
                self._wake()
        if not waited_for:
            then()

    def stop(self, seconds: float) -> None:
        """Stop receiving; wait at most *seconds* for the thread."""
        with self._lock:
            self._stopped = True
            self._wake()
        self._thread.join(seconds)

    def _wake(self) -> None:
        self._changed = True
        if not self._over:
            self._guard.trigger()

    def _run(self) -> None:
        try:
            while not self._stopped:
                self._receive_until_changed()
        except Exception as problem:  # rclpy's internals, such as the wait set, may change
            if not self._stopped and self._context.ok():
                what = f"{type(problem).__name__}: {problem}"
                self._report(f"the fast receiver failed; rclpy's executor takes over: {what}")
                self.group.given_back = True
                self._wake_executor()
        with self._lock:
            self._over = True
            self._guard.destroy()
        self._let_go()

    def _let_go(self) -> None:
        with self._lock:
            leaving, self._leaving = self._leaving, []
        for then in leaving:
            then()

    def _receive_until_changed(self) -> None:
        with self._lock:
            self._changed = False
            takers = list(self._takers.items())
        self._let_go()
        with ExitStack() as held:
            # Entities held here are destroyed by other threads only after their release.
            handles, events, sources = [], [], {}
            for subscription, take in takers:
                handle = subscription.handle
                with suppress(InvalidHandle):  # destroyed with its node
                    held.enter_context(handle)
                    handles.append(handle)
                    sources[handle.pointer] = (handle, subscription.msg_type, take)
                    for event in subscription.event_handlers:
                        held.enter_context(event)
                        events.append(event)
            held.enter_context(self._guard.handle)
            held.enter_context(self._context.handle)
            self._receive(handles, events, sources)

    def _receive(
        self, handles: list[Any], events: list[Any], sources: dict[int, tuple[Any, Any, Take]]
    ) -> None:
        waiting = wait_set(len(handles), 1, len(events), self._context.handle)
        guard = self._guard.handle

        def arm() -> None:
            waiting.clear_entities()
            for handle in handles:
                waiting.add_subscription(handle)
            waiting.add_guard_condition(guard)
            for event in events:
                event.add_to_wait_set(waiting)

        arm()
        while not self._changed:
            waiting.wait(-1)
            ready = [sources[pointer] for pointer in waiting.get_ready_entities("subscription")]
            arrived = [
                (take, *found)
                for handle, kind, take in ready
                if (found := self._taken(handle, kind)) is not None
            ]
            if len(arrived) > 1:
                # Messages that wait together are in the order of the subscriptions: "stop" must not overtake "go".
                arrived.sort(key=_received)
            happened = [(event, event.take_data()) for event in events if event.is_ready(waiting)]
            # Do everything here first: once the loop is awake, it shares the interpreter with this thread.
            arm()
            for take, message, _ in arrived:
                take(message)
            for event, data in happened:
                if data:
                    event.callback(data)

    def _taken(self, handle: Any, kind: Any) -> Any:
        try:
            return take_message(handle, kind)
        except Exception as problem:  # one bad message must not block the node
            text = f"a message of type {kind.__name__} cannot be read: {type(problem).__name__}: {problem}"
            if text not in self._reported:
                self._reported.add(text)
                self._report(text)
            return None
