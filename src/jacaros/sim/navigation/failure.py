"""Why a robot did not get where it should, in Nav2's numbers."""

FAILED_TO_MAKE_PROGRESS = 105
"""Nav2's ``FollowPath``: the robot does not get any further."""
START_OUTSIDE_MAP = 203
GOAL_OUTSIDE_MAP = 204
START_OCCUPIED = 205
GOAL_OCCUPIED = 206
NO_VALID_PATH = 208
"""203 to 208 are codes of Nav2's ``ComputePathToPose``; Nav2's navigator hands the codes of its parts on as its own."""
TF_ERROR = 9002
TIMEOUT = 9003
"""Nav2's ``NavigateToPose``."""
NO_POSES = 309
"""Nav2's ``ComputePathThroughPoses``: nothing to go through."""


def through_poses(code: int) -> int:
    """The same failure of ``NavigateThroughPoses``: planning and navigating through poses have numbers of their own."""
    return code if code == FAILED_TO_MAKE_PROGRESS else code + 100


class NavigationFailure(Exception):
    """The goal cannot be reached.

    Attributes:
        code: one of the numbers above.
        text: why, in words.
    """

    def __init__(self, code: int, text: str) -> None:
        super().__init__(text)
        self.code, self.text = code, text
