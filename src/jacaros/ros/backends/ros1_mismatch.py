"""Publishers whose definition of a message differs from ours: rospy says so in its log alone, and receives nothing."""

import logging
import re
from collections.abc import Callable

_TEXT = re.compile(
    r"wants topic \[?(?P<topic>/[\w/]+)\]? to have datatype/md5sum \[(?P<ours>[\w/]+)/(?P<our_md5>\w+)\], "
    r"but our version has \[(?P<theirs>[\w/]+)/(?P<their_md5>\w+)\]"
)
"""What publishers of rospy and roscpp answer to a subscriber that they refuse."""


class MismatchWatch(logging.Handler):
    """Reads rospy's own log for refusals by publishers.

    Args:
        tell: takes topic, type as on ROS 1, the publisher's md5 sum and ours; called on a thread of rospy's.
    """

    def __init__(self, tell: Callable[[str, str, str, str], None]) -> None:
        super().__init__(logging.ERROR)
        self._tell = tell

    def emit(self, record: logging.LogRecord) -> None:
        """Read one line."""
        found = _TEXT.search(record.getMessage())
        # Other types are told by the master, and earlier; see `TopicFeed.see_type`.
        if found is not None and found["ours"] == found["theirs"]:
            self._tell(found["topic"], found["ours"], found["their_md5"], found["our_md5"])
