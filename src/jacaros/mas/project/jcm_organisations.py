"""Organisations and institutions in `.jcm` project files: read and checked, but without effect."""

from collections.abc import Callable

from jacaros.mas.project.cursor import Token
from jacaros.mas.project.jcm_values import JcmValues
from jacaros.mas.project.parts import OrganisationPart
from jacaros.mas.project.unsupported import INSTITUTIONS, ORGANISATIONS, ROLES


class JcmOrganisations(JcmValues):
    """Reads ``organisation name : file { ... }`` and ``institution name : file { ... }``."""

    def organisation(self) -> None:
        """Read one organisation. The cursor is on the keyword."""
        part = self._head("organisation")
        self.unsupported(ORGANISATIONS, f"the organisation `{part.name}`", part.span)
        self._body(lambda: self._organisation_entry(part), ("group", "scheme", "debug"))

    def institution(self) -> None:
        """Read one institution. The cursor is on the keyword."""
        part = self._head("institution")
        self.unsupported(INSTITUTIONS, f"the institution `{part.name}`", part.span)
        self._body(lambda: self._institution_entry(part), ("debug",))

    def _head(self, what: str) -> OrganisationPart:
        cursor = self.cursor
        cursor.advance()
        name = cursor.lower_name(f"the name of an {what}")
        part = OrganisationPart(name.text, cursor.span_of(name))
        if cursor.accept(":"):
            self.file_name(f"the file of the {what}")
        self.part.organisations.append(part)
        return part

    def _body(self, entry: Callable[[], None], entries: tuple[str, ...]) -> None:
        """Read an optional block of keys and of *entries*."""
        if self.cursor.token.kind != "{":
            return
        around, self.entries = self.entries, entries
        try:
            self.block(entry)
        finally:
            self.entries = around

    def _organisation_entry(self, part: OrganisationPart) -> None:
        if self._at("group"):
            self._group(part)
        elif self._at("scheme"):
            self._scheme(part)
        elif not self._took_debug():
            key = self.key(("agents", "situated", "debug"), "an organisation")
            if key.text == "agents":
                part.agents += self.names()
            else:
                self.pieces()

    def _institution_entry(self, part: OrganisationPart) -> None:
        if not self._took_debug():
            key = self.key(("workspaces", "debug"), "an institution")
            if key.text == "workspaces":
                part.workspaces += self.names()
            else:
                self.pieces()

    def _group(self, part: OrganisationPart) -> None:
        name = self._typed("group")
        self.unsupported(ORGANISATIONS, f"the group `{name.text}`", self.cursor.span_of(name), detail=True)
        self._body(lambda: self._group_entry(part, name), ("group", "debug"))

    def _group_entry(self, part: OrganisationPart, group: Token) -> None:
        if self._at("group"):
            self._group(part)
        elif not self._took_debug():
            key = self.key(("players", "responsible-for", "owner", "debug"), "a group")
            if key.text == "players":
                self._players(part, group)
            elif key.text == "owner":
                part.agents += self.names()
            else:
                self.pieces()

    def _players(self, part: OrganisationPart, group: Token) -> None:
        """Read ``agent role``, any number of times."""
        cursor = self.cursor
        while cursor.token.kind in ("word", "*") and not self.at_end():
            agent = cursor.advance()
            if agent.kind == "word":
                part.agents.append((agent.text, cursor.span_of(agent)))
            if cursor.token.kind != "word" or cursor.token.first or self.at_end():
                cursor.fail(
                    f"expected the role of `{agent.text}`, found {cursor.token}",
                    help="write `players: agent role, agent role`",
                )
            role = cursor.advance()
            span = cursor.span_of(agent).to(cursor.span_of(role))
            what = f"the role `{role.text}` of `{agent.text}` in `{group.text}`"
            self.unsupported(ROLES, what, span)
            self.node(f"the role `{role.text}`")
            cursor.accept(",")

    def _scheme(self, part: OrganisationPart) -> None:
        name = self._typed("scheme")
        self.unsupported(ORGANISATIONS, f"the scheme `{name.text}`", self.cursor.span_of(name), detail=True)
        self._body(lambda: self._scheme_entry(part), ("debug",))

    def _scheme_entry(self, part: OrganisationPart) -> None:
        if not self._took_debug():
            key = self.key(("owner", "debug"), "a scheme")
            if key.text == "owner":
                part.agents += self.names()
            else:
                self.pieces()

    def _typed(self, what: str) -> Token:
        """Read ``group name : type`` and return the name."""
        cursor = self.cursor
        cursor.advance()
        name = cursor.name(f"the name of a {what}")
        cursor.expect(":", f"write `{what} name : type`")
        cursor.name(f"the type of the {what}")
        return name

    def _at(self, entry: str) -> bool:
        return self.cursor.token.text == entry and not self.cursor.at_key()

    def _took_debug(self) -> bool:
        if not self._at("debug"):
            return False
        self.cursor.advance()
        return True
