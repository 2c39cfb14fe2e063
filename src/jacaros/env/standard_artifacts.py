"""The standard artifacts of every workspace: blackboard, console, system, and manuals of types."""

from jacaros.env.artifact import Artifact, Out, operation
from jacaros.env.ids import ArtifactId
from jacaros.env.manual import Manual, describe, manual_term
from jacaros.env.tree import WorkspaceTree
from jacaros.env.values import equal, plain, text
from jacaros.env.workspace import Workspace
from jacaros.env.workspace_artifact import WorkspaceArtifact, refuse

Entry = tuple[object, ...]


class Blackboard(Artifact):
    """A tuple space, as in the coordination language Linda.

    A tuple is a name with any number of arguments. A pattern matches a tuple of the same length if its bound arguments
    are equal. Unbound arguments are outputs and match anything; the same variable twice matches only equal values. The
    oldest matching tuple is used.
    """

    def init(self) -> None:
        """Start without tuples."""
        self._tuples: list[Entry] = []

    @operation
    def out(self, *entry: object) -> None:
        """Add a tuple. Its arguments must be bound."""
        if any(isinstance(item, Out) for item in entry):
            self.fail(
                "a tuple on the blackboard must be ground: it has an unbound variable", "unbound_argument"
            )
        self._tuples.append(tuple(map(plain, entry)))

    @operation(name="in", guard="is_there")
    def take(self, *pattern: object) -> None:
        """Remove a matching tuple. Waits until there is one."""
        taken = self._bind(pattern)
        self._tuples = [entry for entry in self._tuples if entry is not taken]

    @operation(guard="is_there")
    def rd(self, *pattern: object) -> None:
        """Read a matching tuple. Waits until there is one."""
        self._bind(pattern)

    @operation
    def inp(self, *pattern: object) -> None:
        """Remove a matching tuple. Fails with reason ``no_match`` if no tuple matches."""
        self._need(pattern)
        self.take(*pattern)

    @operation
    def rdp(self, *pattern: object) -> None:
        """Read a matching tuple. Fails with reason ``no_match`` if no tuple matches."""
        self._need(pattern)
        self._bind(pattern)

    def is_there(self, *pattern: object) -> bool:
        """Return whether a tuple matches *pattern*."""
        return self._find(pattern) is not None

    def _need(self, pattern: Entry) -> None:
        if not self.is_there(*pattern):
            shown = ",".join("_" if isinstance(item, Out) else text(item, quoted=True) for item in pattern)
            self.fail(f"no tuple on the blackboard matches ({shown})", "no_match")

    def _find(self, pattern: Entry) -> Entry | None:
        return next((entry for entry in self._tuples if _fits(pattern, entry)), None)

    def _bind(self, pattern: Entry) -> Entry:
        entry = self._find(pattern)
        assert entry is not None, "the guard was true"
        for wanted, value in zip(pattern, entry, strict=True):
            if isinstance(wanted, Out):
                wanted.set(value)
        return entry


def _fits(pattern: Entry, entry: Entry) -> bool:
    if len(pattern) != len(entry):
        return False
    bound: dict[int, object] = {}
    for wanted, value in zip(pattern, entry, strict=True):
        if isinstance(wanted, Out):
            wanted = bound.setdefault(id(wanted.variable or wanted), value)
        if not equal(wanted, value):
            return False
    return True


class Console(Artifact):
    """Prints lines for agents, one line for each call.

    The lines go to ``resources["console"]``, a function of agent and text, or else to the log. The operations with
    ``AgName`` are equivalent, because the host shows the agent anyway.
    """

    @operation(name="printWithAgName")
    @operation(name="printlnWithAgName")
    @operation(name="print")
    @operation
    def println(self, *arguments: object) -> None:
        """Print the arguments as one line, without separators."""
        write_line(self, "".join(map(text, arguments)))


def write_line(artifact: Artifact, line: str) -> None:
    """Print a line for the agent that called an operation of *artifact*."""
    write = artifact.resources.get("console")
    if callable(write):
        write(artifact.caller, line)
    else:
        artifact.log(line)


class SystemArtifact(Artifact):
    """The process in which agents and artifacts run."""

    @operation(name="shutdownNode")
    def shut_down(self) -> None:
        """End the run, as ``.stopMAS`` does."""
        stop = self.resources.get("stop")
        if not callable(stop):
            refuse(self, "the host does not support ending the run")
        stop()

    @operation
    def crash(self) -> None:
        """Kill the process. Not supported."""
        refuse(self, "a run cannot be killed; use shutdownNode or .stopMAS to end it")

    @operation(name="spawnNode")
    def spawn(self, *arguments: object) -> None:
        """Start another process. Not supported yet."""
        refuse(self, "starting other processes is not supported yet")


class ManualRepository(Artifact):
    """Manuals of artifact types.

    Every type has a manual, generated from its code: operations, properties and signals with their descriptions. Agents may
    replace the text of a manual.
    """

    def init(self, workspace: Workspace, tree: WorkspaceTree) -> None:
        """Start without manuals of agents."""
        self._here, self._tree = workspace, tree
        self._stored: dict[str, str] = {}

    @operation(name="storeManual")
    def store(self, type_name: str, content: str) -> None:
        """Store a text as the manual of a type."""
        self._stored[str.__str__(type_name)] = content

    @operation(name="getManualContent")
    def give_content(self, type_name: str, content: Out) -> None:
        """Return the manual of a type as a text."""
        content.set(self._content(type_name))

    @operation(name="consultManual")
    def consult(self, type_name: str) -> None:
        """Print the manual of a type."""
        for line in self._content(type_name).splitlines():
            write_line(self, line)

    @operation(name="getManual")
    def give(self, what: ArtifactId | str, manual: Out) -> None:
        """Return the manual of a type or an artifact (with its own operations) as a term."""
        manual.set(manual_term(self._manual(what)))

    def _content(self, type_name: str) -> str:
        stored = self._stored.get(type_name)
        return stored if stored is not None else str(self._manual(type_name))

    def _manual(self, what: ArtifactId | str) -> Manual:
        if isinstance(what, ArtifactId):
            workspace = self._tree.workspace(what.workspace)
            if isinstance(workspace, Workspace):
                return workspace.manual(what)
            what = what.type_name
        return describe(self._here.artifact_type(what))


DEFAULT_TYPES = frozenset(
    each.__name__ for each in (Blackboard, Console, ManualRepository, SystemArtifact, WorkspaceArtifact)
)
"""Type names of the standard artifacts."""


def add_standard_artifacts(workspace: Workspace, tree: WorkspaceTree) -> None:
    """Add the standard artifacts to a workspace. Each one is created at its first use."""
    workspace.offer("blackboard", Blackboard)
    workspace.offer("console", Console)
    workspace.offer("manrepo", ManualRepository, (workspace, tree))
    workspace.offer("system", SystemArtifact)
    workspace.offer("workspace", WorkspaceArtifact, (workspace, tree))
