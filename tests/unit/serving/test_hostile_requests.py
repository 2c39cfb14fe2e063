"""Ten thousand requests of random names, data and texts: each has a clear error, or the effect that is offered."""

import random
from collections.abc import Callable
from typing import Any

from serving_lab import Lab, run

from jacaros.serving.callers import RequestError
from jacaros.serving.service import Session

REQUESTS = 10_000
CODES = {
    *("unknown_agent", "unknown_goal", "not_offered", "not_permitted", "invalid_arguments", "too_large"),
    *("too_many_requests", "unanswerable"),
}
WORDS = (
    *("bob", "deliver", "count", "guard", "search", "battery", "double", "endless", "saying", "closed", "hidden"),
    *("secret", "kitchen", "office", "X", "_", "[source(self)]", "::", "~", ".print(a)", ".stopMAS", ".send(bob, tell, p)"),
    *('"', "'", "(", ")", "[", "]", "{", "}", "|", ",", ";", "<-", ":-", "+!", "&", "not ", "\\", "\0", "\n", "\u202e"),
    *("1", "-3", "1e308", "1/0", "0.1", "..", "//", "/*", "true", "{ include(\"/etc/passwd\") }", "é", "\ud800"),
)  # fmt: skip


def words(chance: random.Random) -> str:
    """Return a text, which may be long or deep."""
    if chance.random() < 0.01:
        return chance.choice(("[", "f(", "(", "x", '"')) * chance.choice((100, 1_900, 100_000))
    name = chance.choice(("deliver", "count", "battery", "double", "closed", "secret", "endless", "saying"))
    arguments = ", ".join(
        "".join(chance.choices(WORDS, k=chance.randint(1, 3))) for _ in range(chance.randint(0, 3))
    )
    return (
        f"{name}({arguments})"
        if chance.random() < 0.7
        else "".join(chance.choices(WORDS, k=chance.randint(0, 9)))
    )


def data(chance: random.Random, depth: int = 0) -> Any:
    """Return JSON data, which may be large or deep."""
    kind = chance.randint(0, 9 if depth < 4 else 6)
    if kind > 6:
        inner = [data(chance, depth + 1) for _ in range(chance.randint(0, 3))]
        if kind == 7:
            return inner
        return {
            chance.choice(("atom", "functor", "arguments", "parcel", "room", "n", "x")): each
            for each in inner
        }
    if chance.random() < 0.005:
        return chance.choice(("x" * 1_000_000, [0] * 100_000, nested(5_000)))
    return chance.choice(
        (None, True, 0, -1, 2**70, 1e308, float("nan"), float("inf"), "", "kitchen", words(chance))
    )


def nested(depth: int) -> Any:
    """Return a list in a list in a list."""
    found: Any = 1
    for _ in range(depth):
        found = [found]
    return found


def ignored(_: object) -> None:
    """Hear of beliefs."""


def request(session: Session, chance: random.Random) -> Callable[[], object]:
    """Return a random request that is not a coroutine."""
    agent = "bob" if chance.random() < 0.9 else words(chance)
    name = chance.choice(WORDS[:12]) if chance.random() < 0.9 else words(chance)
    arguments = data(chance)
    if not isinstance(arguments, list | dict):
        arguments = [arguments]
    requests: tuple[Callable[[], object], ...] = (
        lambda: session.achieve(agent, name, arguments),
        lambda: session.achieve(agent, words(chance)),
        lambda: session.ask(agent, words(chance)),
        lambda: session.ask(agent, name, arguments),
        lambda: session.tell(agent, name, arguments, chance.random() < 0.5),
        lambda: session.tell(agent, words(chance)),
        lambda: session.beliefs(agent, name),
        lambda: session.watch(agent, name, ignored),
        lambda: session.goal(words(chance)),
        lambda: session.cancel(words(chance)),
        lambda: session.offers(agent),
    )
    return chance.choice(requests)


def attack(lab: Lab, role: str, requests: int) -> dict[str, int]:
    """Make requests in a role. Return how often each code was the answer; empty for none."""
    chance, codes = random.Random(role), dict[str, int]()
    session = lab.session(role, role)
    for number in range(requests):
        if number % 500 == 0:
            session.close()
            session = lab.session(role, role)  # its limits begin anew
        code = ""
        try:
            request(session, chance)()
        except RequestError as error:
            code = error.code if 0 < len(str(error)) < 3_000 else "unclear"
        codes[code] = codes.get(code, 0) + 1
    return codes


def test_an_observer_changes_nothing_whatever_it_asks() -> None:
    async def test(lab: Lab) -> None:
        await lab.mas.sleep(1)
        bob = lab.mas.agent("bob")
        before = (bob.beliefs, bob.goals, len(bob.mind.library.plans))
        codes = attack(lab, "observer", REQUESTS // 2)
        assert codes.keys() <= CODES | {""}
        assert min(codes[each] for each in ("", "not_offered", "not_permitted", "invalid_arguments")) > 50
        await lab.mas.sleep(10)
        assert (bob.beliefs, bob.goals, len(bob.mind.library.plans)) == before

    assert run(test) == []


def test_a_user_does_what_is_offered_and_nothing_else() -> None:
    async def test(lab: Lab) -> None:
        await lab.mas.sleep(1)
        bob = lab.mas.agent("bob")
        plans, agents = len(bob.mind.library.plans), lab.mas.agents
        names = {each.partition("(")[0] for each in bob.beliefs}
        codes = attack(lab, "user", REQUESTS // 2)
        assert codes.keys() <= CODES | {""}
        assert codes["invalid_arguments"] > 500
        await lab.mas.sleep(100)
        assert (len(bob.mind.library.plans), lab.mas.agents) == (plans, agents)
        added = {each.partition("(")[0] for each in bob.beliefs} - names
        assert added <= {"closed"}

    for line in run(test):
        assert line.startswith(("[bob] test:user closed ", "[bob] tidying", "[bob] tidied")), line
