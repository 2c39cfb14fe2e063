"""Says once, and loudly, which real graphs the contract suite does not run on."""

import pytest
from presence import need


@pytest.mark.parametrize("kind", ["ros1", "ros2"])
def test_the_real_graph_is_there(kind: str, request: pytest.FixtureRequest) -> None:
    need(kind, request.config)
