"""Ten thousand broken requests of ROS clients: each has an answer that says why, and none has an effect."""

import random
from typing import Any

import pytest

import jacaros
from jacaros import Mas
from jacaros.robots.ros.action import GoalStatus
from jacaros.serving.ros.door import RosDoor
from jacaros.serving.service import service_of

PROGRAM = """
{ offer(goal, deliver(parcel(string), room([kitchen, office]))) }
{ offer(goal, count(n(number(0, 10)), m(out(number)))) }
{ offer(goal, repair, role(mechanic)) }
{ offer(question, double(x(number), y(out(number)))) }
{ offer(tell, closed(room(atom))) }
double(X, 2*X).
+!deliver(_, _) <- +touched.
+!count(N, N+1) <- +touched.
+!repair        <- +touched.
+!secret        <- +touched.
+closed(_)      <- +touched.
"""
REQUESTS = 10_000
ERRORS = {
    "invalid_arguments",
    "not_offered",
    "not_permitted",
    "too_large",
    "too_many_requests",
    "unanswerable",
}
WRITTEN = r"""
! { [ " deliver deliver() deliver( deliver(p) secret repair repair() count(x,M) closed null [[]] .stopMAS not(closed(x))
{"parcel":1,"room":"kitchen"} {"parcel":"p"} {"parcel":"p","room":"cellar"} ["p",7] {"n":NaN} {"n":1e999} {"n":true}
count(1e400,M) count(-1,M) count(11,M) deliver(P,kitchen) double(X,X,X) x&y x:-y self::count(1,M) {"n":null}
"""
LARGE = (
    "[" * 60_000,
    "a" * 3000,
    "count(" + "(" * 900 + "1" + ")" * 900 + ", M)",
    '{"a":' * 40 + "1" + "}" * 40,
)
BROKEN = ("", "\x00", "\U0001f916", *WRITTEN.split(), *LARGE)


def mangled(chance: random.Random) -> str:
    """A broken request, or one with characters taken out, doubled or exchanged that breaks it."""
    text = chance.choice(BROKEN)
    for _ in range(chance.randrange(4)):
        place = chance.randrange(len(text) + 1)
        text = (
            text[:place]
            + chance.choice(("", "(", ")", "]", '"', "\\", "\u2028", ",", "@", "::"))
            + text[place:]
        )
    return text


class Client:
    """Another node that sends nonsense."""

    def __init__(self, mas: Mas) -> None:
        node: Any = mas.system.ros.companion("client")
        self._actions = [
            node.action_client(f"bob/{name}", "jacaros_interfaces/action/Achieve")
            for name in ("deliver", "count", "achieve")
        ]
        self._ask = node.client("bob/ask", "jacaros_interfaces/srv/Ask")
        self._tell = node.client("bob/tell", "jacaros_interfaces/srv/Tell")

    async def give(self, chance: random.Random, text: str) -> str:
        """Send a request, and return the code of its error."""
        way = chance.randrange(5)
        if way < 3:
            outcome = await (await self._actions[way].send({"goal": text})).outcome()
            assert outcome.status is GoalStatus.ABORTED, text
            assert outcome.result.message, text
            return str(outcome.result.state)
        client, field = ((self._ask, "question"), (self._tell, "belief"))[way - 3]
        answer = await client.call({field: text})
        assert not answer.success, text
        return str(answer.message).partition(":")[0]


@pytest.mark.slow
def test_broken_requests_have_no_effect() -> None:
    async def main() -> None:
        chance = random.Random(7)
        log: list[str] = []
        async with Mas(world="none", seed=1, on_log=lambda text, _: log.append(text)) as mas:
            bob = mas.add_agent("bob", PROGRAM)
            RosDoor(mas.system)
            client = Client(mas)
            codes = set()
            for number in range(REQUESTS):
                codes.add(await client.give(chance, mangled(chance)))
                if number % 500 == 0:
                    await mas.sleep(1)
            assert codes <= ERRORS, codes
            assert bob.ask("touched") is None
            assert not service_of(mas.system).goals
            assert len(log) <= 2, log[:5]

    jacaros.run(main(), clock="fast")
