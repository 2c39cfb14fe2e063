"""The roots of the exception tree; every package adds its own branches.

    JacarosError
    ├── AslError            (asl)   a wrong program: carries diagnostics with file, line and excerpt
    ├── ProjectError        (mas)   a wrong .mas2j or .jcm file
    ├── WorkspaceError      (env)   wrong use of workspaces and artifacts
    ├── RosError            (ros)   middleware: missing backend, unknown interface, mismatch, time-out
    └── UsageError                  a wrong command line or a wrong combination of options
    InternalError                   a defect of JaCaROS itself: stops the robot, ends the run

A goal that fails is none of these: it becomes a ``-!g`` event with reason terms.
"""


class JacarosError(Exception):
    """Something the user can put right; ``str()`` says what is wrong, where, and what to do."""


class UsageError(JacarosError):
    """A wrong command line or a wrong combination of options."""


class InternalError(Exception):
    """A defect of JaCaROS itself, never of a program: it ends the run and stops the robot."""
