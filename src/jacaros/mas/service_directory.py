"""The directory facilitator: who provides which service.

As in Jason it is an agent, ``df``, made at its first use: what it knows are its beliefs, so it can be asked.
"""

from collections.abc import Callable, Sequence

from jacaros.bdi.mind import Mind
from jacaros.bdi.rules import belief_update
from jacaros.bdi.state.speech_act import SpeechAct
from jacaros.terms.values import BY_SELF, Annotated, String, Term, atom, functor

NAME = "df"
_PROVIDER, _SUBSCRIBE = functor("provider", 2), functor("subscribe", 2)

Watcher = Callable[[str, str, bool], None]
"""Told of an agent, a service, and whether the agent provides it from now on."""


class ServiceDirectory:
    """Keeps providers and subscribers of services; it is the `jacaros.mas.ports.Services` of a run.

    Args:
        make: makes the agent that keeps them.
        deliver: brings a message to its receiver.
    """

    def __init__(self, make: Callable[[], Mind], deliver: Callable[[SpeechAct], bool]) -> None:
        self._make = make
        self._deliver = deliver
        self._agent: Mind | None = None
        self._watchers: list[Watcher] = []

    @property
    def agent(self) -> Mind:
        """The agent, made when it is first asked for."""
        if self._agent is None:
            self._agent = self._make()
        return self._agent

    def register(self, name: str, service: str) -> None:
        """An agent provides a service; its subscribers are told."""
        if name not in self.providers(service):
            belief_update.tell(self.agent, (_PROVIDER, atom(name), String(service)))
            self._changed(name, service, True)
        for subscriber in self._held(_SUBSCRIBE, service):
            self._tell(subscriber, name, service)

    def deregister(self, name: str, service: str) -> None:
        """It does not any more."""
        believed = Annotated((_PROVIDER, atom(name), String(service)), BY_SELF)
        belief_update.untell(self.agent, believed)
        self._changed(name, service, False)

    def providers(self, service: str) -> Sequence[str]:
        """The agents that provide a service, in the order of their registration."""
        return self._held(_PROVIDER, service)

    def subscribe(self, name: str, service: str) -> None:
        """An agent wants to be told of all providers; of those there are it is told now."""
        if name not in self._held(_SUBSCRIBE, service):
            belief_update.tell(self.agent, (_SUBSCRIBE, atom(name), String(service)))
        for provider in self.providers(service):
            self._tell(name, provider, service)

    def watch(self, watcher: Watcher) -> Callable[[], None]:
        """Call *watcher* whenever an agent begins (True) or ceases (False) to provide a service; gives what ends that.

        For those that keep a copy elsewhere.
        """
        self._watchers.append(watcher)
        return lambda: self._watchers.remove(watcher) if watcher in self._watchers else None

    def _changed(self, name: str, service: str, provides: bool) -> None:
        for watcher in tuple(self._watchers):
            watcher(name, service, provides)

    def _held(self, symbol: Term, service: str) -> list[str]:
        rows = [row for row, _ in self.agent.beliefs[symbol].entries() if isinstance(row, tuple)]
        return [row[0].name for row in reversed(rows) if row[1] == String(service)]

    def _tell(self, receiver: str, provider: str, service: str) -> None:
        content = (_PROVIDER, atom(provider), String(service))
        self._deliver(SpeechAct("tell", NAME, receiver, content, self.agent.next_message_id(), None))
