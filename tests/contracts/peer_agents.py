"""Commands of a peer about agents that offer goals."""

from typing import Any

from jacaros.robots.mapping.file import read_mapping
from jacaros.robots.mapping.offer_codec import codec_of
from jacaros.robots.ros.backend import Backend
from jacaros.runtime.mas.embedding.mas import Mas
from jacaros.serving.ros.door import RosDoor


class AgentCommands:
    """Running an agent with the peer as its node; a part of `peer.Peer`."""

    _backend: Backend

    def __init__(self) -> None:
        self._systems: list[Mas] = []
        self._doors: dict[str, RosDoor] = {}
        self._printed: list[str] = []

    async def offer(self, agent: str, program: str, mapping: str = "") -> None:
        """Start an agent, and offer what its program offers."""
        mas = Mas(seed=1, on_print=lambda _, text: self._printed.append(text), on_log=lambda *_: None)
        await mas.__aenter__()
        self._systems.append(mas)
        mas.system.ros.joined = self._backend
        mas.add_agent(agent, program)
        problems: list[Any] = []
        parts = read_mapping(mapping).offers if mapping else {}
        codecs = {name: codec_of(part, self._backend, problems) for name, part in parts.items()}
        assert not problems, problems
        self._doors[agent] = RosDoor(mas.system, {name: codec for name, codec in codecs.items() if codec})

    def printed(self) -> list[str]:
        return self._printed

    def activate(self, agent: str, active: bool) -> None:
        self._doors[agent].active = active

    def callers(self, agent: str) -> list[str]:
        """Who gave the agent its goals."""
        return [str(each.caller) for each in self._doors[agent]._service.goals.values()]

    def close_door(self, agent: str) -> None:
        self._doors[agent].close()

    async def end_agents(self) -> None:
        for mas in self._systems:
            mas.system.ros.joined = None
            await mas.__aexit__(None, None, None)
        self._systems.clear()
