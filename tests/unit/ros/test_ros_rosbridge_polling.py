"""Values from rosapi are valid for one connection only."""

from typing import Any

from jacaros.ros.protocols.rosbridge_wire import Polled, Requests


class Server:
    """Answers requests when a test wants."""

    def __init__(self) -> None:
        self.asked: list[str] = []
        self.requests = Requests(self._take, lambda question, seconds: None)
        self.polled = Polled(
            self.requests, "/rosapi/subscribers", {}, lambda seen: len(seen["subscribers"]), 0
        )

    def _take(self, operation: dict[str, Any]) -> bool:
        self.asked.append(operation["id"])
        return True

    def answer(self, *subscribers: str) -> None:
        self.requests.answered({"id": self.asked[-1], "values": {"subscribers": list(subscribers)}})


def test_values_of_a_lost_connection_are_forgotten_and_requested_immediately() -> None:
    server = Server()
    assert server.polled.value == 0
    server.answer("/robot")
    assert server.polled.value == 1
    server.requests.fail_all()
    assert server.polled.value == 0
    assert len(server.asked) == 2
    server.answer("/robot", "/other")
    assert server.polled.value == 2


def test_an_answer_lost_with_the_connection_is_requested_again_immediately() -> None:
    server = Server()
    assert server.polled.value == 0
    server.requests.fail_all()
    assert server.polled.value == 0
    assert len(server.asked) == 2
    assert server.polled.value == 0
    assert len(server.asked) == 2
