"""Zenoh alone, over the same kind of link: publications there and back, queries, and publications as fast as it can.

plain.py FLEET NAME [PARTNER]
"""

import itertools
import os
import sys
import threading
import time
from typing import Any

import zenoh
from orders import Orders

from jacaros.fleet.network import Network, session_config

PAYLOAD = b"x" * 120
"""About what a message of an agent takes."""


def answering(session: Any, name: str) -> None:
    """Send back what arrives, answer queries, and publish on request."""
    back = session.declare_publisher(f"back/{name}", express=True)
    ticks = session.declare_publisher(
        f"ticks/{name}", express=True, congestion_control=zenoh.CongestionControl.BLOCK
    )

    def publish(seconds: float) -> None:
        end = time.perf_counter() + seconds
        while time.perf_counter() < end:
            for _ in range(20):
                ticks.put(PAYLOAD)
        ticks.put(b"")

    def begin(sample: Any) -> None:
        threading.Thread(target=publish, args=(float(sample.payload.to_string()),), daemon=True).start()

    declared = [
        session.declare_subscriber(f"there/{name}", lambda sample: back.put(sample.payload)),
        session.declare_queryable(f"ask/{name}", lambda query: query.reply(f"ask/{name}", PAYLOAD)),
        session.declare_subscriber(f"begin/{name}", begin),
    ]
    orders = Orders()
    orders.ready()
    orders.next()
    del declared


class Asking:
    """Measures at the side that asks.

    Args:
        session: the session.
        partner: the answering process.
    """

    def __init__(self, session: Any, partner: str) -> None:
        self._session, self._partner = session, partner
        self._there = session.declare_publisher(f"there/{partner}", express=True)
        self._back = session.declare_subscriber(f"back/{partner}")
        self._ticks = session.declare_subscriber(f"ticks/{partner}")

    def messages(self, count: float) -> list[float]:
        """Measure messages there and back."""
        times = []
        for _ in range(int(count)):
            began = time.perf_counter()
            self._there.put(PAYLOAD)
            self._back.recv()
            times.append((time.perf_counter() - began) * 1e6)
        return times

    def operations(self, count: float) -> list[float]:
        """Measure queries."""
        times = []
        for _ in range(int(count)):
            began = time.perf_counter()
            for _ in self._session.get(f"ask/{self._partner}", payload=PAYLOAD):
                pass
            times.append((time.perf_counter() - began) * 1e6)
        return times

    def updates(self, seconds: float) -> list[float]:
        """Measure the time between arrivals."""
        self._session.put(f"begin/{self._partner}", str(seconds))
        seen = []
        while bytes(self._ticks.recv().payload):
            seen.append(time.perf_counter())
        return [(later - earlier) * 1e6 for earlier, later in itertools.pairwise(seen)]


def main(fleet: str, name: str, partner: str) -> None:
    """Run one process until its input ends."""
    with zenoh.open(session_config(Network(fleet, name))) as session:
        if partner:
            asking = Asking(session, partner)
            orders = Orders()
            orders.ready()
            while order := orders.next():
                what, amount = order
                orders.answer(getattr(asking, what)(amount))
        else:
            answering(session, name)
    os._exit(0)  # a thread of Zenoh that survives the interpreter would abort the process


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], sys.argv[3] if len(sys.argv) > 3 else "")
