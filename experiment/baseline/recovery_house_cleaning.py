"""House cleaning as in `house_cleaning.py`, but each way runs through the recovery tree of Nav2's `bt_navigator`."""

import rclpy
from house_cleaning import HouseCleaning
from recovery import Recovering


class RecoveryHouseCleaning(Recovering, HouseCleaning):
    """The house cleaning with recoveries."""


def main():
    rclpy.init()
    rclpy.spin(RecoveryHouseCleaning())


if __name__ == "__main__":
    main()
