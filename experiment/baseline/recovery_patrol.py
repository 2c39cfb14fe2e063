"""Patrol as in `patrol.py`, but each way runs through the recovery tree of Nav2's `bt_navigator`."""

import rclpy
from patrol import Patrol
from recovery import Recovering


class RecoveryPatrol(Recovering, Patrol):
    """The patrol with recoveries."""


def main():
    rclpy.init()
    rclpy.spin(RecoveryPatrol())


if __name__ == "__main__":
    main()
