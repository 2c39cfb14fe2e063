"""``rclpy.callback_groups``: which callbacks may run at the same time. Here none do, but those of several threads
run while one of them waits."""


class CallbackGroup:
    """A group of callbacks."""


class MutuallyExclusiveCallbackGroup(CallbackGroup):
    """Callbacks that wait for each other."""


class ReentrantCallbackGroup(CallbackGroup):
    """Callbacks that do not."""
