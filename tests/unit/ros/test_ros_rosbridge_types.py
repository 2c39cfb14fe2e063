"""Unknown types, with a rosbridge server that does not know them either or does not answer."""

from typing import Any

import pytest

from jacaros.ros.errors import UnknownInterface
from jacaros.ros.protocols.rosbridge_messages import BridgeSchema


def test_a_server_that_has_not_answered_is_not_said_to_know_nothing_and_is_asked_again() -> None:
    answers: list[Any] = [TimeoutError(), None]

    def ask(service: str, arguments: dict[str, Any]) -> dict[str, Any] | None:
        answer = answers.pop(0)
        if isinstance(answer, Exception):
            raise answer
        return answer

    schema = BridgeSchema((), ask, lambda: None)
    with pytest.raises(UnknownInterface, match="has not answered yet"):
        schema.fields("odd_msgs/msg/Thing")
    with pytest.raises(UnknownInterface, match="the rosbridge server does not know it either"):
        schema.fields("odd_msgs/msg/Thing")
    assert answers == []
