"""What a call of a command returns to a test."""

from collections.abc import Callable

Outcome = Callable[..., tuple[int, str, str]]
"""Exit code, standard output and standard error output; made by the fixture ``outcome``."""

Told = Callable[..., str]
"""The output of a command that succeeds without errors; made by the fixture ``told``."""
