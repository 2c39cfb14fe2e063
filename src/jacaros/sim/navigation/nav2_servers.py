"""Navigation actions of Nav2 and of move_base, served by the same navigator.

Names, fields and error codes are those of Nav2 (Jazzy; ``error_msg`` of Kilted) and of ROS 1's move_base.
"""

import asyncio
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from jacaros.plane.pose import Placement
from jacaros.ros.action import GoalStatus
from jacaros.ros.backend import Backend
from jacaros.ros.node import Sample, Subscription
from jacaros.sim.navigation.failure import NO_POSES, TF_ERROR, NavigationFailure, through_poses
from jacaros.sim.navigation.frames import MAP, Frames, FrameUnknown, fault_of, fill_in
from jacaros.sim.navigation.navigator import Navigator
from jacaros.sim.navigation.servers import Goal, Servers
from jacaros.sim.navigation.trip import Progress, go
from jacaros.sim.navigation.wheels import Overtaken

POSE = "geometry_msgs/msg/PoseStamped"
NO_VALID_WAYPOINTS = 602
_TO_POSE, _THROUGH_POSES = "navigate_to_pose", "navigate_through_poses"


class NavigationServers:
    """Serves navigation of one robot.

    Args:
        navigator: drives the robot.
        frames: frames of the robot.
        servers: action servers of the robot.
    """

    def __init__(self, navigator: Navigator, frames: Frames, servers: Servers) -> None:
        self.navigator, self.frames, self.servers = navigator, frames, servers
        self._backend: Backend = servers.backend
        self._subscriptions: list[Subscription] = []
        self._simple: asyncio.Task[None] | None = None
        self._navigator: str | None = None

    def offer_nav2(self) -> None:
        """``/navigate_to_pose``, ``/navigate_through_poses``, ``/follow_waypoints``, the topic ``/goal_pose``, and the
        services ``/global_costmap/clear_entirely_global_costmap`` and ``/local_costmap/clear_entirely_local_costmap``."""
        self.servers.action(
            "/navigate_to_pose",
            "nav2_msgs/action/NavigateToPose",
            self._to_pose,
            lambda goal: fault_of(goal.pose),
        )
        self.servers.action(
            "/navigate_through_poses",
            "nav2_msgs/action/NavigateThroughPoses",
            self._through_poses,
            _poses_fault,
        )
        self.servers.action(
            "/follow_waypoints", "nav2_msgs/action/FollowWaypoints", self._waypoints, _poses_fault
        )
        for map_ in ("global", "local"):
            self.servers.service(
                f"/{map_}_costmap/clear_entirely_{map_}_costmap",
                "nav2_msgs/srv/ClearEntireCostmap",
                self._forget_obstacles,
            )
        self._hear("/goal_pose")

    def offer_move_base(self) -> None:
        """``/move_base``, the topic ``/move_base_simple/goal`` and the service ``/move_base/clear_costmaps``."""
        self.servers.action(
            "/move_base", "move_base_msgs/action/MoveBase", self._move_base, overtaken=GoalStatus.CANCELED
        )
        self.servers.service("/move_base/clear_costmaps", "std_srvs/srv/Empty", self._forget_obstacles)
        self._hear("/move_base_simple/goal")

    def close(self) -> None:
        """Withdraw the topics; the actions are withdrawn by `Servers.close`."""
        for subscription in self._subscriptions:
            subscription.close()
        if self._simple is not None:
            self._simple.cancel()

    def _forget_obstacles(self, request: Any) -> Mapping[str, Any]:
        """Forget closed doors; other robots are perceived anew for every path."""
        self.navigator.perception.forget()
        return {}

    def _hear(self, topic: str) -> None:
        name = self.servers.name(topic)
        if name is not None:
            self._subscriptions.append(self._backend.subscription(name, POSE, self._simple_goal))

    @contextmanager
    def _navigating(self, navigator: str, goal: Goal) -> Iterator[None]:
        """Run a goal; like Nav2's two navigators, preempt only goals of the same one, and abort those of the other."""
        if self._navigator not in (None, navigator):
            goal.abort(f"{self._navigator} is running; cancel that goal first")
        self._navigator = navigator
        try:
            yield
        finally:
            self._navigator = None

    async def _to_pose(self, goal: Goal) -> Mapping[str, Any]:
        def tell(progress: Progress) -> None:
            goal.feedback(**self._feedback(progress))

        with self._navigating(_TO_POSE, goal):
            await self._go(goal, [goal.request.pose], tell)
        return {}

    async def _through_poses(self, goal: Goal) -> Mapping[str, Any]:
        def tell(progress: Progress) -> None:
            goal.feedback(**self._feedback(progress), number_of_poses_remaining=progress.poses_left)

        poses = _poses(goal.request)
        if not poses:
            goal.abort("the goal has no poses", error_code=NO_POSES)
        with self._navigating(_THROUGH_POSES, goal):
            await self._go(goal, poses, tell, through_poses)
        return {}

    async def _move_base(self, goal: Goal) -> Mapping[str, Any]:
        def tell(progress: Progress) -> None:
            goal.feedback(base_position=self._stamped(progress.pose))

        # move_base accepts any goal, and aborts invalid ones.
        fault = fault_of(goal.request.target_pose)
        if fault is not None:
            goal.abort(fault)
        await self._go(goal, [goal.request.target_pose], tell)
        return {}

    async def _waypoints(self, goal: Goal) -> Mapping[str, Any]:
        """Stop at each waypoint; if one cannot be reached, record it as missed and try the next."""
        poses = _poses(goal.request)
        if not poses:
            goal.abort("the goal has no waypoints", error_code=NO_VALID_WAYPOINTS)
        missed = []
        for turn in range(goal.request.number_of_loops + 1):
            for index in range(goal.request.goal_index if turn == 0 else 0, len(poses)):
                goal.feedback(current_waypoint=index)
                try:
                    await self._drive([poses[index]], lambda progress: None)
                except NavigationFailure as failure:
                    missed.append(self._missed(index, poses[index], failure))
        return {"missed_waypoints": missed}

    def _missed(self, index: int, pose: Any, failure: NavigationFailure) -> Any:
        type_name = "nav2_msgs/msg/MissedWaypoint"
        fields = {"index": index, "goal": pose, "error_code": failure.code, "error_msg": failure.text}
        known = self._backend.fields(type_name)
        return self._backend.message(
            type_name, **{name: value for name, value in fields.items() if name in known}
        )

    async def _go(
        self,
        goal: Goal,
        poses: list[Any],
        tell: Callable[[Progress], None],
        coded: Callable[[int], int] = int,
    ) -> None:
        try:
            await self._drive(poses, tell)
        except NavigationFailure as failure:
            goal.abort(failure.text, error_code=coded(failure.code))

    async def _drive(self, poses: list[Any], tell: Callable[[Progress], None]) -> None:
        self.navigator.pose()  # updates the estimate
        try:
            places = [await self.frames.on_map(pose) for pose in poses]
        except FrameUnknown as problem:
            raise NavigationFailure(TF_ERROR, str(problem)) from None
        await go(self.navigator, places, tell)

    def _stamped(self, place: Placement) -> Any:
        return fill_in(
            self._backend.message(POSE), place, self.frames.prefix + MAP, self.navigator.time.now()
        )

    def _feedback(self, progress: Progress) -> dict[str, Any]:
        speed = self.navigator.pace.speed
        return {
            "current_pose": self._stamped(progress.pose),
            "navigation_time": progress.time,
            "estimated_time_remaining": progress.remaining / speed,
            "number_of_recoveries": progress.recoveries,
            "distance_remaining": progress.remaining,
        }

    def _simple_goal(self, sample: Sample) -> None:
        """Start a goal without an action, which has no feedback or result."""
        if fault_of(sample.message) is not None:
            self._backend.rosout("error", f"goal on {sample.topic}: {fault_of(sample.message)}")
            return
        if self._simple is not None:
            self._simple.cancel()
        self._simple = asyncio.get_running_loop().create_task(self._drive_simply(sample.message))

    async def _drive_simply(self, pose: Any) -> None:
        try:
            await self._drive([pose], lambda progress: None)
        except NavigationFailure as failure:
            self._backend.rosout("error", f"cannot reach the goal pose: {failure.text}")
        except Overtaken:
            return


def _poses(request: Any) -> list[Any]:
    """Return the poses of a goal: a list, or ``nav_msgs/msg/Goals`` since Kilted."""
    return list(getattr(request.poses, "goals", request.poses))


def _poses_fault(request: Any) -> str | None:
    poses = _poses(request)
    for index, pose in enumerate(poses):
        fault = fault_of(pose)
        if fault is not None:
            return f"pose {index}: {fault}"
    return None
