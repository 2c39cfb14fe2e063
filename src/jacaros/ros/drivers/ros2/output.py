"""Keeping the middleware below ROS 2 away from standard output, which belongs to the agents."""

import os
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

PROFILES = "FASTRTPS_DEFAULT_PROFILES_FILE"
"""Names the file with Fast DDS 2's settings; version 3 calls it otherwise and reports on standard error anyway."""

LOGGERS = "RCUTILS_LOGGING_USE_STDOUT"
"""Whether rclpy's loggers write to standard output."""


def leave_standard_output_alone() -> None:
    """Have Fast DDS 2 and rclpy's loggers report on standard error, before they start.

    A file with Fast DDS's settings of the user's own is left alone.
    """
    os.environ[LOGGERS] = "0"
    middleware = os.environ.get("RMW_IMPLEMENTATION", "rmw_fastrtps_cpp")
    if middleware.startswith("rmw_fastrtps") and PROFILES not in os.environ and _is_fast_dds_2():
        os.environ[PROFILES] = str(Path(__file__).with_name("fastdds_log.xml"))


def _is_fast_dds_2() -> bool:
    # The package was renamed to fastdds with version 3.
    if find_spec("fastrtps") is not None:  # pip wheels
        return True
    try:
        import_module("ament_index_python.packages").get_package_prefix("fastrtps")
    except (ImportError, LookupError, OSError, ValueError):
        return False
    return True
