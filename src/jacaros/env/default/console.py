"""The console: agents print through it."""

from jacaros.env.artifact import Artifact, operation
from jacaros.env.values import text


class Console(Artifact):
    """Prints for agents, one line for each call, arguments written one after the other.

    The lines go to ``resources["console"]``, a function of agent and text; without it to the log.  The
    names with ``AgName`` are other names of the same: the host shows who prints anyway.
    """

    @operation(name="printWithAgName")
    @operation(name="printlnWithAgName")
    @operation(name="print")
    @operation
    def println(self, *arguments: object) -> None:
        """Print the arguments as one line."""
        write_line(self, "".join(map(text, arguments)))


def write_line(artifact: Artifact, line: str) -> None:
    """Print a line for the agent that has called an operation of *artifact*."""
    write = artifact.resources.get("console")
    if callable(write):
        write(artifact.caller, line)
    else:
        artifact.log(line)
