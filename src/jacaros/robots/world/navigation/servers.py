"""The actions, topics and services of a navigating robot: those of Nav2 and of move_base, served by the same navigator.

Names, fields and error codes are those of Nav2 (Jazzy; ``error_msg`` of Kilted) and of ROS 1's move_base.
"""

import asyncio
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from typing import Any

from jacaros.robots.plane.pose import Placement, Point
from jacaros.robots.ros.action import GoalStatus
from jacaros.robots.ros.backend import Sample
from jacaros.robots.world.data.grid import Grid
from jacaros.robots.world.graph.frames import MAP, POSE, FrameUnknown, on_map, pose_fault, stamped_pose
from jacaros.robots.world.graph.on_graph import ActiveGoal, Overtaken, RobotOnGraph
from jacaros.robots.world.navigation.docking import Docking
from jacaros.robots.world.navigation.navigator import Navigator
from jacaros.robots.world.navigation.planner import NO_POSES, TF_ERROR, NavigationFailure, through_poses
from jacaros.robots.world.navigation.trip import TripProgress, go

NO_VALID_WAYPOINTS = 602
_TO_POSE, _THROUGH_POSES = "navigate_to_pose", "navigate_through_poses"


class RobotNavigation:
    """The navigation and docking of one robot.

    It offers the actions of Nav2 and of the Create 3 on ROS 2, those of move_base and of the Kobuki on ROS 1, and all of
    them on the memory graph.

    Args:
        robot: the robot on the graph.
        grid: creates the grid of the world; called on first use.
    """

    def __init__(self, robot: RobotOnGraph, grid: Callable[[], Grid]) -> None:
        self._at = at = RobotOnGraph(robot.time, robot.robot, robot.backend, robot.localisation)
        self._navigator = Navigator(at, grid)
        self._simple: asyncio.Task[None] | None = None
        self._running: str | None = None
        docks = Docking(self._navigator)
        if at.backend.ros_version == 2:
            self._offer_nav2()
            docks.offer_nav2()
            docks.offer_create3()
        if at.backend.ros_version == 1 or at.backend.name == "memory":
            self._offer_move_base()
            docks.offer_kobuki()

    @property
    def name(self) -> str:
        """Name of the robot."""
        return self._at.robot.name

    @property
    def path(self) -> Sequence[Point]:
        """Points of the current path, in metres on the map; empty without a goal."""
        return self._navigator.path

    def close(self) -> None:
        """Withdraw everything, and stop the robot."""
        self._at.close()
        if self._simple is not None:
            self._simple.cancel()
        self._navigator.wheels.close()

    def _offer_nav2(self) -> None:
        at, serve = self._at, self._navigator.serve
        kind = "nav2_msgs/action/"
        serve(
            "/navigate_to_pose",
            kind + "NavigateToPose",
            self._to_pose,
            lambda goal: pose_fault(goal.pose.pose),
        )
        serve(
            "/navigate_through_poses",
            kind + "NavigateThroughPoses",
            self._through_poses,
            _poses_fault,
            coded=through_poses,
        )
        serve("/follow_waypoints", kind + "FollowWaypoints", self._waypoints, _poses_fault)
        for map_ in ("global", "local"):
            name = f"/{map_}_costmap/clear_entirely_{map_}_costmap"
            at.service(name, "nav2_msgs/srv/ClearEntireCostmap", self._forget_obstacles)
        at.subscribe("/goal_pose", POSE, self._simple_goal)

    def _offer_move_base(self) -> None:
        at = self._at
        kind = "move_base_msgs/action/MoveBase"
        self._navigator.serve("/move_base", kind, self._move_base, overtaken=GoalStatus.CANCELED)
        at.service("/move_base/clear_costmaps", "std_srvs/srv/Empty", self._forget_obstacles)
        at.subscribe("/move_base_simple/goal", POSE, self._simple_goal)

    def _forget_obstacles(self, request: Any) -> Mapping[str, Any]:
        """Forget closed doors; other robots are perceived anew for every path."""
        self._navigator.perception.forget()
        return {}

    @contextmanager
    def _navigating(self, navigator: str, goal: ActiveGoal) -> Iterator[None]:
        """Run a goal; like Nav2's two navigators, preempt only goals of the same one, and abort those of the other."""
        if self._running not in (None, navigator):
            goal.abort(f"{self._running} is running; cancel that goal first")
        self._running = navigator
        try:
            yield
        finally:
            self._running = None

    async def _to_pose(self, goal: ActiveGoal) -> Mapping[str, Any]:
        with self._navigating(_TO_POSE, goal):
            return await self._go(goal, [goal.request.pose], self._feedback)

    async def _through_poses(self, goal: ActiveGoal) -> Mapping[str, Any]:
        def feedback(progress: TripProgress) -> dict[str, Any]:
            return {**self._feedback(progress), "number_of_poses_remaining": progress.poses_left}

        poses = _poses(goal.request)
        if not poses:
            goal.abort("the goal has no poses", error_code=NO_POSES)
        with self._navigating(_THROUGH_POSES, goal):
            return await self._go(goal, poses, feedback)

    async def _move_base(self, goal: ActiveGoal) -> Mapping[str, Any]:
        # move_base accepts any goal, and aborts invalid ones.
        pose = goal.request.target_pose
        fault = pose_fault(pose.pose)
        if fault is not None:
            goal.abort(fault)
        return await self._go(goal, [pose], lambda progress: {"base_position": self._stamped(progress.pose)})

    async def _waypoints(self, goal: ActiveGoal) -> Mapping[str, Any]:
        """Stop at each waypoint; if one cannot be reached, record it as missed and try the next."""
        poses = _poses(goal.request)
        if not poses:
            goal.abort("the goal has no waypoints", error_code=NO_VALID_WAYPOINTS)
        missed = []
        for turn in range(goal.request.number_of_loops + 1):
            for index in range(goal.request.goal_index if turn == 0 else 0, len(poses)):
                goal.feedback(current_waypoint=index)
                try:
                    await self._drive([poses[index]])
                except NavigationFailure as failure:
                    missed.append(self._missed(index, poses[index], failure))
        return {"missed_waypoints": missed}

    def _missed(self, index: int, pose: Any, failure: NavigationFailure) -> Any:
        type_name = "nav2_msgs/msg/MissedWaypoint"
        fields = {"index": index, "goal": pose, "error_code": failure.code, "error_msg": failure.text}
        known = self._at.backend.fields(type_name)
        return self._at.backend.message(
            type_name, **{name: value for name, value in fields.items() if name in known}
        )

    async def _go(
        self, goal: ActiveGoal, poses: list[Any], feedback: Callable[[TripProgress], dict[str, Any]]
    ) -> Mapping[str, Any]:
        await self._drive(poses, lambda progress: goal.feedback(**feedback(progress)))
        return {}

    async def _drive(self, poses: list[Any], tell: Callable[[TripProgress], object] = bool) -> None:
        self._navigator.pose()  # updates the estimate
        try:
            places = [await on_map(self._at, pose) for pose in poses]
        except FrameUnknown as problem:
            raise NavigationFailure(TF_ERROR, str(problem)) from None
        await go(self._navigator, places, tell)

    def _stamped(self, place: Placement) -> Any:
        return stamped_pose(self._at, place, MAP)

    def _feedback(self, progress: TripProgress) -> dict[str, Any]:
        return {
            "current_pose": self._stamped(progress.pose),
            "navigation_time": progress.time,
            "estimated_time_remaining": progress.remaining / self._navigator.pace.speed,
            "number_of_recoveries": progress.recoveries,
            "distance_remaining": progress.remaining,
        }

    def _simple_goal(self, sample: Sample) -> None:
        """Start a goal without an action, which has no feedback or result."""
        fault = pose_fault(sample.message.pose)
        if fault is not None:
            self._at.backend.rosout("error", f"goal on {sample.topic}: {fault}")
            return
        if self._simple is not None:
            self._simple.cancel()
        self._simple = asyncio.get_running_loop().create_task(self._drive_simply(sample.message))

    async def _drive_simply(self, pose: Any) -> None:
        with suppress(Overtaken):
            try:
                await self._drive([pose])
            except NavigationFailure as failure:
                self._at.backend.rosout("error", f"cannot reach the goal pose: {failure.text}")


def _poses(request: Any) -> list[Any]:
    """Return the poses of a goal: a list, or ``nav_msgs/msg/Goals`` since Kilted."""
    return list(getattr(request.poses, "goals", request.poses))


def _poses_fault(request: Any) -> str | None:
    faults = ((index, pose_fault(pose.pose)) for index, pose in enumerate(_poses(request)))
    return next((f"pose {index}: {fault}" for index, fault in faults if fault is not None), None)
