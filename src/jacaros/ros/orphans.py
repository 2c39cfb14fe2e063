"""Goals of an earlier run whose process was killed: their action servers still pursue them.

Goal ids identify their owner: they begin with the name of the node (ROS 1) or with a hash of it (ROS 2), followed by
the run. So goals of other nodes are never taken for orphans.
"""

import hashlib
import secrets
from collections.abc import Awaitable, Callable
from typing import Literal

OrphanPolicy = Literal["cancel", "keep"] | Callable[[str], Awaitable[bool]]
"""What to do with orphans: cancel them, leave them, or ask a question (text) and cancel them if the answer is True."""


class Orphans:
    """Recognises the goals of earlier runs of one node, and decides about them.

    Args:
        node_name: absolute name of the node.
        policy: what to do with them.
        log: called with a warning.
    """

    def __init__(self, node_name: str, policy: OrphanPolicy, log: Callable[[str], None]) -> None:
        self._policy: OrphanPolicy = policy
        self._log = log
        run = secrets.token_hex(4)
        self._families = (f"{node_name}-", hashlib.sha256(node_name.encode()).hexdigest()[:12])
        self._named, self._hashed = (f"{family}{run}" for family in self._families)
        self._known: set[str] = set()

    def named_id(self, number: int, now: float) -> str:
        """Return an id in actionlib's form: node (and run), number, time."""
        return f"{self._named}-{number}-{now:.9f}"

    def hashed_id(self) -> str:
        """Return an id of 16 bytes, as 32 hexadecimal digits."""
        return self._hashed + secrets.token_hex(6)

    def newly_found(self, goal_id: str) -> bool:
        """Return whether an active goal is an orphan that has not been seen before."""
        if (
            not goal_id.startswith(self._families)
            or goal_id.startswith((self._named, self._hashed))
            or goal_id in self._known
        ):
            return False
        self._known.add(goal_id)
        return True

    async def may_cancel(self, action: str) -> bool:
        """Decide whether to cancel an orphan of *action*, and log it."""
        found = f"action {action} is still executing a goal of an earlier run of this node"
        if self._policy == "cancel":
            self._log(f"warning: {found}; cancelling it")
            return True
        if self._policy == "keep":
            self._log(f"warning: {found}; the robot may be moving")
            return False
        return await self._policy(f"{found}. Cancel it?")
