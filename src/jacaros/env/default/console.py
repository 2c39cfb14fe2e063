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
        line = "".join(map(text, arguments))
        write = self.resources.get("console")
        if callable(write):
            write(self.caller, line)
        else:
            self.log(line)
