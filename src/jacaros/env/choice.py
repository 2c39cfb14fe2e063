"""Which artifact an operation is for, when several offer it: CArtAgO's rule, for agents and for sessions alike."""

from collections.abc import Iterable, Sequence

from jacaros.env.errors import UnknownArtifact
from jacaros.env.ids import ArtifactId
from jacaros.env.offering import Offering, Providers
from jacaros.env.ports import Workspace


def chosen_artifact(
    places: Iterable[Workspace], operation: str, arity: int, own: str, focused: Sequence[ArtifactId]
) -> ArtifactId | None:
    """The artifact that is to serve an operation; None when nobody offers it.

    The first workspace that has one decides.  There, those that take exactly so many arguments come before
    those that take any number; among them the oldest one made by *own*, else the one focused first, else the
    oldest.

    Args:
        places: the workspaces, in the order in which they count.
        operation: its name.
        arity: the number of its arguments.
        own: who asks, as it is noted as the creator of artifacts.
        focused: what they focus, in the order of focusing.
    """
    for workspace in places:
        candidates = workspace.providers(operation, arity)
        if candidates:
            return (
                candidates[0]
                if len(candidates) == 1
                else _preferred(workspace, candidates, operation, arity, own, focused)
            )
    return None


def artifact_named(places: Iterable[Workspace], name: str) -> ArtifactId:
    """The artifact of that name in the first workspace that has one.

    Raises:
        UnknownArtifact: none has.
    """
    failures = []
    for workspace in places:
        try:
            return workspace.lookup(name)
        except UnknownArtifact as failure:
            failures.append(failure)
    raise next((f for f in failures if "did you mean" in f.message), failures[0])


def _preferred(
    workspace: Workspace,
    candidates: Sequence[ArtifactId],
    operation: str,
    arity: int,
    own: str,
    focused: Sequence[ArtifactId],
) -> ArtifactId:
    if isinstance(candidates, Providers):
        offering = candidates.offering
    else:
        # The workspace is served from elsewhere.
        offering = Offering()
        exact = f"{operation}/{arity}"
        for candidate in candidates:
            offering.add(candidate, exact in workspace.offers(candidate))
    of_own = offering.oldest_of(own)
    if of_own is not None:
        return of_own
    return next((artifact for artifact in focused if offering.is_preferred(artifact)), offering.oldest())
