"""Quality of service: the rules by which publishers and subscriptions match."""

from itertools import product

import pytest

from jacaros.robots.ros.errors import RosError
from jacaros.robots.ros.qos import QoS, incompatibility

RELIABLE = ("best_effort", "reliable")
DURABLE = ("volatile", "transient_local")


@pytest.mark.parametrize(("offered", "requested"), list(product(product(RELIABLE, DURABLE), repeat=2)))
def test_a_request_may_not_be_stricter_than_the_offer(
    offered: tuple[str, str], requested: tuple[str, str]
) -> None:
    stricter = RELIABLE.index(requested[0]) > RELIABLE.index(offered[0]) or (
        DURABLE.index(requested[1]) > DURABLE.index(offered[1])
    )
    assert (incompatibility(QoS(*offered), QoS(*requested)) is not None) == stricter  # type: ignore[arg-type]


@pytest.mark.parametrize("wrong", [{"depth": 0}, {"depth": True}, {"depth": 2.5}, {"reliability": "yes"}])
def test_impossible_wishes_are_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(RosError):
        QoS(**wrong)  # type: ignore[arg-type]
