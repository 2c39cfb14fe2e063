"""The artifact ``manrepo``: manuals of artifact types, to be read by agents and shown to people."""

from jacaros.env.artifact import Artifact, Out, operation
from jacaros.env.default.console import write_line
from jacaros.env.ids import ArtifactId
from jacaros.env.manual import Manual, describe, manual_term
from jacaros.env.tree import WorkspaceTree
from jacaros.env.workspace import Workspace


class ManualRepository(Artifact):
    """Manuals of artifact types.

    Every type has one, made from its code: its operations, properties and signals with what its author says of them.
    Agents may put other texts in their places.
    """

    def init(self, workspace: Workspace, tree: WorkspaceTree) -> None:
        """Begin without texts of agents."""
        self._here, self._tree = workspace, tree
        self._stored: dict[str, str] = {}

    @operation(name="storeManual")
    def store(self, type_name: str, content: str) -> None:
        """Keep a text as the manual of a type."""
        self._stored[str.__str__(type_name)] = content

    @operation(name="getManualContent")
    def give_content(self, type_name: str, content: Out) -> None:
        """Give the manual of a type as a text."""
        content.set(self._content(type_name))

    @operation(name="consultManual")
    def consult(self, type_name: str) -> None:
        """Print the manual of a type."""
        for line in self._content(type_name).splitlines():
            write_line(self, line)

    @operation(name="getManual")
    def give(self, what: ArtifactId | str, manual: Out) -> None:
        """Give the manual of a type, or of one artifact with what it has defined for itself, as a term."""
        manual.set(manual_term(self._manual(what)))

    def _content(self, type_name: str) -> str:
        stored = self._stored.get(type_name)
        return stored if stored is not None else str(self._manual(type_name))

    def _manual(self, what: ArtifactId | str) -> Manual:
        if isinstance(what, ArtifactId):
            workspace = self._tree.find(what.workspace)
            if isinstance(workspace, Workspace):
                return workspace.manual(what)
            what = what.type_name
        return describe(self._here.artifact_type(what))
