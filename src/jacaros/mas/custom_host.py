"""The host of an agent with user-defined architectures."""

from collections.abc import Callable, Sequence
from functools import partial
from inspect import isawaitable
from typing import Any

from jacaros.bdi.architecture import Timer
from jacaros.bdi.state.act import NEEDS, Act
from jacaros.bdi.state.speech_act import SpeechAct
from jacaros.extension.agent import Action, AgentArch, Perception
from jacaros.extension.calling import FAULTS, crash_text
from jacaros.extension.views import Message
from jacaros.mas.agent_host import AgentHost, Run


class CustomHost(AgentHost):
    """Calls a chain of architectures, the first one first, and does what they leave to it."""

    def __init__(self, name: str, run: Run, seed: str) -> None:
        super().__init__(name, run, seed)
        self._chain: list[AgentArch] = []
        self._perceiving: list[tuple[AgentArch, Perception]] = []
        self._acting: dict[int, Timer] = {}
        self._leaving: list[Callable[[], Any]] = []

    def take(self, chain: Sequence[AgentArch]) -> None:
        """Put a chain of architectures before this host."""
        self._chain = list(chain)
        following: AgentArch = _End(self)
        for link in reversed(self._chain):
            link.following = following
            following = link
        if self._chain:
            self.send = self._send
        self._perceiving = [
            (link, Perception()) for link in chain if type(link).perceive is not AgentArch.perceive
        ]
        if self._perceiving:
            self.run = self._perceive_and_run

    def at_end(self, leave: Callable[[], Any]) -> None:
        """Call *leave* when the agent ends."""
        self._leaving.append(leave)

    def _perceive_and_run(self, fuel: int) -> bool:
        """Run a turn of the mind. The architectures perceive before each cycle."""
        for _ in range(fuel):
            self._perceive()
            if not self.mind.run(1):
                return False
        return True

    def _perceive(self) -> None:
        for link, perception in self._perceiving:
            found = self._ask(link.perceive, None)
            if found is not None:
                changes = self._ask(partial(perception.changes, found), [])
                # The agent has its turn already, so new percepts need not schedule another one.
                self.queued = True
                self.mind.perceive(changes)
                self.queued = False

    def act(self, act: Act) -> None:
        """Run an external action."""
        if not self._chain or act.functor is NEEDS:
            super().act(act)
            return
        action = Action(act)
        try:
            done = self._chain[0].act(action)
        except FAULTS as error:
            self._failed(action, self._chain[0].act, error)
            return
        if isawaitable(done):
            self._await(action, done)
        elif done is not None:
            self.mind.complete(act.id, action.completion(bool(done)))

    def _await(self, action: Action, work: Any) -> None:
        def ended(done: object, error: BaseException | None) -> None:
            self._acting.pop(action.raw.id, None)
            if error is not None:
                self._failed(action, self._chain[0].act, error)
            else:
                self.mind.complete(action.raw.id, action.completion(done is not False))

        self._acting[action.raw.id] = self.start_coroutine(work, ended)

    def _failed(self, action: Action, method: Callable[..., Any], error: BaseException) -> None:
        told = crash_text(method.__qualname__, method, error)
        self.log("error", told)
        self.mind.complete(action.raw.id, action.completion(False, told))

    def cancel_act(self, act_id: int) -> None:
        """The intention of an action was dropped."""
        under_way = self._acting.pop(act_id, None)
        if under_way is not None:
            under_way.cancel()
        else:
            super().cancel_act(act_id)

    def _send(self, message: SpeechAct) -> bool:
        return bool(self._ask(lambda: self._chain[0].send(Message(message)), False))

    def deliver(self, message: SpeechAct) -> bool:
        """Deliver a message without the architectures."""
        return self._run.deliver(message)

    def receive(self, message: SpeechAct) -> None:
        """Pass a message to the mind, if the architectures accept it."""
        if not self._chain or self._ask(lambda: self._chain[0].check_mail(Message(message)), True):
            super().receive(message)

    def end(self) -> None:
        """Cancel all actions, then end the user-defined objects."""
        super().end()
        for leave in self._leaving:
            self._ask(leave, None)

    def _ask(self, method: Callable[[], Any], default: Any) -> Any:
        """Return the result of the project's code, or the default if it raises."""
        try:
            return method()
        except FAULTS as error:
            self.log("error", crash_text(getattr(method, "__qualname__", "?"), method, error))
            return default


class _End(AgentArch):
    """The last link of a chain: the host itself."""

    def __init__(self, host: CustomHost) -> None:
        self._host = host

    def act(self, action: Action) -> None:
        AgentHost.act(self._host, action.raw)

    def send(self, message: Message) -> bool:
        return self._host.deliver(message.raw)

    def check_mail(self, message: Message) -> bool:
        return True

    def wake(self) -> None:
        self._host.ready()
