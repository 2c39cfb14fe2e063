"""How a signal ends a run by force."""

import warnings

import pytest

from jacaros.runtime.mas.launch import Interrupted, Interruption


async def _step() -> None:
    """A coroutine that has been created but not awaited yet."""


def test_what_a_forced_end_interrupts_causes_no_warning() -> None:
    def interrupted() -> None:
        step = _step()
        try:
            interruption._interrupt(2, None)
        finally:
            del step

    interruption = Interruption(lambda line: None)
    with warnings.catch_warnings(), pytest.raises(Interrupted):
        interrupted()
