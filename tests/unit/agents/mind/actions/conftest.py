import pytest
from fake_context import FakeContext


@pytest.fixture
def mind() -> FakeContext:
    return FakeContext()
