"""Taking messages: a thread with a wait set of our own, beside rclpy's executor.

For each message rclpy's executor goes three times, in Python, through all that the node has: publishers' and subscriptions'
events, services, clients.  Together with the change of threads that made an agent's reaction half as slow again as a bare
callback.  Here a wait costs a few calls for each topic, and nothing else is looked at.

All that we use of rclpy's inner side is in this file.  Any release may change it: when something is another one, or there
no more, rclpy's executor does what is done here.
"""

import threading
from collections.abc import Callable
from contextlib import ExitStack, suppress
from importlib import import_module
from typing import Any

from rclpy.callback_groups import CallbackGroup  # type: ignore[import-not-found]
from rclpy.guard_condition import GuardCondition  # type: ignore[import-not-found]


def _inner(name: str) -> Any:
    """Something of rclpy's extension module; None when it is there no more."""
    try:
        module = import_module("rclpy.impl.implementation_singleton")
        return getattr(module.rclpy_implementation, name, None)
    except (ImportError, AttributeError):
        return None


RCLError: type[Exception] = _inner("RCLError") or RuntimeError
"""What rclpy raises when rcl refuses something; a `RuntimeError` in all releases."""
InvalidHandle: type[Exception] = _inner("InvalidHandle") or RuntimeError
"""Raised by the handle of something that has been destroyed."""


def wait_set(subscriptions: int, guards: int, events: int, context: Any) -> Any:
    """Make a wait set of rcl.

    Args:
        subscriptions, guards, events: how many of each will be waited for.
        context: the handle of rclpy's context.

    Raises:
        NotImplementedError: rclpy has none.
    """
    made = _inner("WaitSet")
    if made is None:
        raise NotImplementedError("rclpy shows no wait sets")
    return made(subscriptions, guards, 0, 0, 0, events, context)


Take = Callable[[Any], None]


class NotForExecutor(CallbackGroup):  # type: ignore[misc]
    """A group of subscriptions that rclpy's executor leaves alone, unless they are given back to it."""

    given_back = False

    def add_entity(self, entity: Any) -> None:
        """Nothing is to be noted; rclpy's groups never forget what was in them."""

    def can_execute(self, entity: Any) -> bool:
        """Whether the executor may wait for *entity*."""
        return self.given_back

    def beginning_execution(self, entity: Any) -> bool:
        """Whether the executor may call the callback of *entity*; it has one thread and asks for one at a time."""
        return self.given_back

    def ending_execution(self, entity: Any) -> None:
        """Nothing is to be noted."""


def take_message(handle: Any, kind: Any) -> Any:
    """Take a message of class *kind* with what is told about it; None when somebody else has taken it."""
    return handle.take_message(kind, False)


class Receiver:
    """Takes the messages of subscriptions, which are made with the callback group `group`.

    Args:
        context: rclpy's context.
        report: takes one line about a fault; called in the receiver's thread.
        executor: rclpy's, for all else; it gets the subscriptions too when the receiver cannot go on.
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
        """Have *take* called with each message of *subscription*, in the receiver's thread; it must not block.

        Its other news (deadline, quality of service) is told in this thread too: an executor that waits for it wakes up
        with each message, on Fast DDS, and has the interpreter just when it is needed here.
        """
        # A subscription that rclpy has made itself is of another group so far.
        for entity in (subscription, *subscription.event_handlers):
            entity.callback_group = self.group
        with self._lock:
            self._takers[subscription] = take
            self._wake()

    def remove(self, subscription: Any, then: Callable[[], None]) -> None:
        """Let go of *subscription*, and call *then* when it is not waited for any more."""
        with self._lock:
            self._takers.pop(subscription, None)
            waited_for = not self._over
            if waited_for:
                self._leaving.append(then)
                self._wake()
        if not waited_for:
            then()

    def stop(self, seconds: float) -> None:
        """Take nothing more; wait at most *seconds* for the thread."""
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
        except Exception as problem:  # rclpy's inner side, which the wait set is, may be another one day
            if not self._stopped and self._context.ok():
                what = f"{type(problem).__name__}: {problem}"
                self._report(
                    f"waiting for messages the fast way failed, rclpy's executor does it now: {what}"
                )
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
            # What is held here is destroyed by others only after it was let go.
            handles, events, sources = [], [], {}
            for subscription, take in takers:
                handle = subscription.handle
                with suppress(InvalidHandle):  # gone with its node
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
                (take, found[0])
                for handle, kind, take in ready
                if (found := self._taken(handle, kind)) is not None
            ]
            happened = [(event, event.take_data()) for event in events if event.is_ready(waiting)]
            # First all that is left to do here: once the loop is awake it shares the interpreter with this thread.
            arm()
            for take, message in arrived:
                take(message)
            for event, data in happened:
                if data:
                    event.callback(data)

    def _taken(self, handle: Any, kind: Any) -> Any:
        try:
            return take_message(handle, kind)
        except Exception as problem:  # one bad message must not make the node deaf
            text = f"a message of type {kind.__name__} cannot be read: {type(problem).__name__}: {problem}"
            if text not in self._reported:
                self._reported.add(text)
                self._report(text)
            return None
