"""The root exceptions; every package derives its own from these.

    JacarosError
    ├── AslError            (asl)   a program with errors: diagnostics with file, line and excerpt
    ├── ProjectError        (mas)   an invalid .mas2j or .jcm file
    ├── WorkspaceError      (env)   wrong use of workspaces and artifacts
    ├── RosError            (ros)   middleware: missing backend, unknown interface, mismatch, timeout
    └── UsageError                  an invalid command line or combination of options
    InternalError                   a defect of JaCaROS itself: stops the robot, ends the run

A failed goal is not an exception: it becomes a ``-!g`` event with reason terms.
"""


class JacarosError(Exception):
    """An error that the user can fix; ``str()`` says what is wrong, where, and how to fix it."""


class UsageError(JacarosError):
    """An invalid command line or combination of options."""


class InternalError(Exception):
    """A defect of JaCaROS itself, never of a program: it ends the run and stops the robot."""
