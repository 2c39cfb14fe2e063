"""Behaviours that check the observable properties of focused artifacts."""

from collections.abc import Callable, Mapping, Sequence

from py_trees.common import Status

from jacaros.artifacts.env.errors import ArtifactId, OperationFailed, UnknownProperty
from jacaros.artifacts.env.values import equal, plain, text
from jacaros.artifacts.presence.presence import ObservedProperty
from jacaros.behaviour_trees.artifact_behaviour import ArtifactBehaviour


class PropertyCheck(ArtifactBehaviour):
    """SUCCESS if a property has matching values, otherwise FAILURE; of several with one name, one is enough.

    Args:
        property_name: its name.
        predicate: called with the values of the property, such as ``lambda level: level > 20``; default: any values
            match. If it raises an exception, the behaviour fails.
        artifact: the artifact with the property; default: any focused one.
        name: name of the behaviour; default: the property's name with a question mark.
    """

    otherwise = Status.FAILURE

    def __init__(
        self,
        property_name: str,
        predicate: Callable[..., object] | None = None,
        *,
        artifact: ArtifactId | str | None = None,
        name: str | None = None,
    ) -> None:
        super().__init__(name or f"{property_name}?")
        self.property_name, self.predicate, self.artifact = property_name, predicate, artifact

    def update(self) -> Status:
        """Check the property."""
        try:
            seen = self.session.properties(self.property_name, artifact=self.artifact)
            if not seen:
                self.session.value(self.property_name, artifact=self.artifact)
        except (OperationFailed, UnknownProperty) as unknown:
            self.feedback_message = str(unknown)
            return self.otherwise
        self.feedback_message = ", ".join(map(_shown, seen))
        try:
            return Status.SUCCESS if any(map(self._fits, seen)) else self.otherwise
        except Exception as error:
            self.complain("the predicate", error)
            return Status.FAILURE

    def _fits(self, seen: ObservedProperty) -> bool:
        return self.predicate is None or bool(self.predicate(*seen.values))


class WaitForProperty(PropertyCheck):
    """As `PropertyCheck`, but RUNNING until the values match."""

    otherwise = Status.RUNNING


class HasProperty(PropertyCheck):
    """SUCCESS if a property has these values, otherwise FAILURE.

    Args:
        property_name: its name.
        values: all its values; default: any.
        artifact: the artifact with the property; default: any focused one.
        name: name of the behaviour; default: such as ``holder(driver)?``.
    """

    def __init__(
        self,
        property_name: str,
        *values: object,
        artifact: ArtifactId | str | None = None,
        name: str | None = None,
    ) -> None:
        wanted = [plain(value) for value in values]
        shown = f"{property_name}({', '.join(map(text, wanted))})" if wanted else property_name
        super().__init__(
            property_name,
            (lambda *found: equal(list(found), wanted)) if wanted else None,
            artifact=artifact,
            name=name or f"{shown}?",
        )


class PropertiesToBlackboard(ArtifactBehaviour):
    """Copy properties to the blackboard at every tick; always SUCCESS.

    A property with one value yields that value, any other a tuple; of several with one name, the first counts. The
    key of a missing property is removed. As with topics, place it first below a ``Parallel``.

    Args:
        properties: names of properties, which are also the keys; or a dictionary from names to keys.
        artifact: the artifact with the properties; default: any focused one.
        name: name of the behaviour.
    """

    def __init__(
        self,
        properties: str | Sequence[str] | Mapping[str, str],
        *,
        artifact: ArtifactId | str | None = None,
        name: str = "properties to blackboard",
    ) -> None:
        super().__init__(name)
        if isinstance(properties, str):
            properties = [properties]
        self.keys = (
            dict(properties) if isinstance(properties, Mapping) else {each: each for each in properties}
        )
        self.artifact = artifact
        for key in self.keys.values():
            self.may_write(key)

    def update(self) -> Status:
        """Copy the properties."""
        missing = [name for name, key in self.keys.items() if not self._copy(name, key)]
        self.feedback_message = f"no focused artifact has {', '.join(missing)}" if missing else ""
        return Status.SUCCESS

    def _copy(self, name: str, key: str) -> bool:
        try:
            values = self.session.properties(name, artifact=self.artifact)[0].values
        except (OperationFailed, IndexError):
            self.board.unset(key)
            return False
        self.board.set(key, values[0] if len(values) == 1 else values)
        return True


def _shown(seen: ObservedProperty) -> str:
    values = ", ".join(text(value, True) for value in seen.values)
    return f"{seen.name}({values})" if values else seen.name
