"""Options of a run."""

import pytest

from jacaros.errors import UsageError
from jacaros.mas.options import RunOptions


def test_the_defaults_go_together() -> None:
    RunOptions().check()


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (RunOptions(fast=True, ros="ros1"), "use --clock real"),
        (RunOptions(fast=True, ros="ros2"), "use --clock real"),
        (RunOptions(ros="ros3"), "there are memory, ros1, ros2"),
        (RunOptions(seconds=-1), "not negative"),
    ],
)
def test_what_cannot_go_together_is_refused(options: RunOptions, text: str) -> None:
    with pytest.raises(UsageError, match=text):
        options.check()
