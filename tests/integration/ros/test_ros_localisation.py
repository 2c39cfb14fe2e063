"""``/amcl_pose`` of the world on real graphs: latched, and published again after a new initial pose."""

from processes import WorldProcess, wait_until

TYPE = "geometry_msgs/msg/PoseWithCovarianceStamped"


def test_the_pose_is_latched_and_follows_initial_poses(world: WorldProcess, peer) -> None:
    first = peer("first")
    first.subscribe("/amcl_pose", TYPE, durability="transient_local", depth=1)
    wait_until(lambda: first.received("/amcl_pose"), "the first pose comes")
    [told] = first.received("/amcl_pose")
    assert told["header"]["frame_id"] == "map"
    assert list(told["pose"]["covariance"])[::7] == [0.0025, 0.0025, 0.0, 0.0, 0.0, 0.001]
    late = peer("late")
    late.subscribe("/amcl_pose", TYPE, durability="transient_local", depth=1)
    wait_until(lambda: late.received("/amcl_pose"), "a late one gets it, too")
    [kept] = late.received("/amcl_pose")
    # ROS 1 counts what goes out in `seq`, also when it is the same message.
    assert (kept["pose"], kept["header"]["stamp"]) == (told["pose"], told["header"]["stamp"])
    late.advertise("/initialpose", TYPE)
    wait_until(lambda: late.subscription_count("/initialpose"), "the robot listens")
    late.publish(
        "/initialpose",
        {
            "header": {"frame_id": "map"},
            "pose": {"pose": {"position": {"x": 3.0}, "orientation": {"w": 1.0}}},
        },
    )

    def there() -> list[float]:
        """Its variances there; they grow, for its scans do not match."""
        poses = [each["pose"] for each in late.received("/amcl_pose")]
        return [each["covariance"][0] for each in poses if each["pose"]["position"]["x"] == 3.0]

    wait_until(there, "it believes the given pose")
    assert there()[0] == 0.0
