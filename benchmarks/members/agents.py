"""One system of a fleet: an agent that asks another one, uses its artifact, and observes it.

agents.py FLEET NAME [PARTNER]
"""

import asyncio
import itertools
import sys
import time

from orders import Orders

import jacaros
from jacaros import Mas
from jacaros.artifacts import Artifact, operation
from jacaros.fleet.joining import joining
from jacaros.fleet.network import Network
from jacaros.fleet.on_zenoh import ZenohCarrier
from jacaros.runtime.mas.embedding.running_agent import RunningAgent
from jacaros.runtime.mas.launch import SWITCH_INTERVAL

ANSWERING = "+!ping(N)[source(S)] <- .send(S, achieve, pong(N))."
ASKING = """
+!pong(0) <- .print(end); +answered.
+!pong(N) <- .print(N); .send(PARTNER, achieve, ping(N - 1)).

+!operate <- joinWorkspace("PLACE"); lookupArtifact("ticker", T); +ticker(T); operate(0).
+!operate(0).
+!operate(N) <- .print(N); operate(N); !operate(N - 1).

+!observe <- joinWorkspace("PLACE"); lookupArtifact("ticker", T); focus(T).
+!publish(Seconds) <- publish(Seconds).
+tick(N) <- .print(N).
"""


class Ticker(Artifact):
    """Does nothing, or publishes as fast as it can."""

    def init(self) -> None:
        self.define_property("tick", 0)

    @operation
    def operate(self, number: int) -> None:
        self.number = number

    @operation
    async def publish(self, seconds: float) -> None:
        end = time.perf_counter() + seconds
        number = 0
        while time.perf_counter() < end:
            for _ in range(20):
                number += 1
                self.update_property("tick", number)
                await self.sleep(0)


class Times:
    """When the agent printed something."""

    def __init__(self) -> None:
        self.seen: list[float] = []

    def note(self, agent: str, text: str) -> None:
        """Note the time of a line."""
        self.seen.append(time.perf_counter())

    def between(self) -> list[float]:
        """Return microseconds between the lines, and forget them."""
        seen, self.seen = self.seen, []
        return [(later - earlier) * 1e6 for earlier, later in itertools.pairwise(seen)]


async def main(fleet: str, name: str, partner: str) -> None:
    """Run one system until its input ends."""
    times = Times()
    carrier = ZenohCarrier(Network(fleet, name))
    async with Mas(name=name, on_print=times.note, on_log=_ignore, join=joining(carrier, name)) as mas:
        if partner:
            agent = mas.add_agent(f"agent_{name}", _program(partner))
        else:
            mas.add_agent(f"agent_{name}", ANSWERING)
            mas.add_artifact_types(Ticker)
            await mas.make_artifact("ticker", Ticker, workspace=mas.create_workspace(f"place_{name}"))
        orders = Orders()
        orders.ready()
        while order := await asyncio.to_thread(orders.next):
            what, amount = order
            orders.answer(await _ACTS[what](agent, times, amount))


def _program(partner: str) -> str:
    return ASKING.replace("PARTNER", f"agent_{partner}").replace("PLACE", f"/main/place_{partner}")


def _ignore(text: str, level: str) -> None:
    if level == "error":
        print(text, file=sys.stderr, flush=True)


async def _messages(agent: RunningAgent, times: Times, count: float) -> list[float]:
    agent.achieve(f"pong({count:.0f})")
    await agent.until("answered", timeout=60)
    agent.remove_belief("answered")
    return times.between()


async def _operations(agent: RunningAgent, times: Times, count: float) -> list[float]:
    await agent.achieve("operate").wait(timeout=10)
    times.seen.clear()
    await agent.achieve(f"operate({count:.0f})").wait(timeout=60)
    return times.between()


async def _updates(agent: RunningAgent, times: Times, seconds: float) -> list[float]:
    await agent.achieve("observe").wait(timeout=10)
    await asyncio.sleep(0.2)
    times.seen.clear()
    await agent.achieve(f"publish({seconds})").wait(timeout=seconds + 30)
    await asyncio.sleep(0.2)
    return times.between()


_ACTS = {"messages": _messages, "operations": _operations, "updates": _updates}


if __name__ == "__main__":
    sys.setswitchinterval(SWITCH_INTERVAL)
    jacaros.run(main(sys.argv[1], sys.argv[2], sys.argv[3] if len(sys.argv) > 3 else ""))
