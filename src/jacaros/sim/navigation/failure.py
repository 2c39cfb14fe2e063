"""Failures of navigation, with Nav2's error codes."""

FAILED_TO_MAKE_PROGRESS = 105
"""Nav2's ``FollowPath``: the robot makes no progress."""
START_OUTSIDE_MAP = 203
GOAL_OUTSIDE_MAP = 204
START_OCCUPIED = 205
GOAL_OCCUPIED = 206
NO_VALID_PATH = 208
"""203 to 208 are codes of Nav2's ``ComputePathToPose``, which Nav2's navigator passes on."""
TF_ERROR = 9002
TIMEOUT = 9003
"""Nav2's ``NavigateToPose``."""
NO_POSES = 309
"""Nav2's ``ComputePathThroughPoses``: no poses."""


def through_poses(code: int) -> int:
    """Return the code of the same failure in ``NavigateThroughPoses``, whose codes differ."""
    return code if code == FAILED_TO_MAKE_PROGRESS else code + 100


class NavigationFailure(Exception):
    """Raised when a goal cannot be reached.

    Attributes:
        code: one of the codes above.
        text: reason.
    """

    def __init__(self, code: int, text: str) -> None:
        super().__init__(text)
        self.code, self.text = code, text
