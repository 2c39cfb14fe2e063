"""What Python code of a project, or around a run, is told of agents."""

from collections.abc import Iterable

from jacaros.errors import JacarosError


class UnknownAgent(JacarosError):
    """Nobody of that name takes part; the text has names that may have been meant."""

    def __init__(self, name: str, known: Iterable[str]) -> None:
        from difflib import get_close_matches  # here: only for a name that is not there

        names = list(known)
        near = get_close_matches(name, names, n=3, cutoff=0.6)
        listed = ", ".join(names[:10]) + (", …" if len(names) > 10 else "")
        hint = f"did you mean {' or '.join(near)}?" if near else f"there are {listed}" if names else ""
        super().__init__(f"there is no agent {name}{'; ' * bool(hint)}{hint}")
        self.name = name
