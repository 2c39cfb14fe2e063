"""The keys of one member: files in a folder that is copied to its computer.

==============  ==================================================================
`ca.pem`        certificate of the fleet's authority
`cert.pem`      certificate of the member: its fleet (O) and name (CN)
`key.pem`       private key of the member
`members.txt`   names of all members, one a line: a name that is missing is refused
==============  ==================================================================
"""

import os
import sys
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING

from jacaros.runtime.errors import UsageError
from jacaros.runtime.files.texts import help_line

if TYPE_CHECKING:
    from cryptography.x509 import Certificate

CA, CERTIFICATE, KEY, MEMBERS = "ca.pem", "cert.pem", "key.pem", "members.txt"
_INSTALL = help_line("pip install 'jacaros[fleet]'")
NO_EXTRA = f"error: fleets need packages that are not installed\n{_INSTALL}"


@dataclass(frozen=True, slots=True)
class Keys:
    """Checked keys of a member.

    Attributes:
        folder: where the files are.
        members: names of all members of the fleet.
    """

    folder: Path
    members: tuple[str, ...]

    def path(self, file: str) -> str:
        """Return the path of a file, such as `CERTIFICATE`."""
        return str(self.folder / file)


def fleet_folder(fleet: str) -> Path:
    """Return the folder of all keys of a fleet: ``jacaros/fleets/FLEET`` in ``$XDG_CONFIG_HOME`` or ``~/.config``."""
    given = os.environ.get("XDG_CONFIG_HOME", "")
    return (Path(given) if os.path.isabs(given) else Path.home() / ".config") / "jacaros" / "fleets" / fleet


def find_keys(fleet: str, member: str) -> Path | None:
    """Return the default folder of a member's keys, or None if it does not exist."""
    folder = fleet_folder(fleet) / member
    return folder if folder.is_dir() else None


def read_keys(folder: Path, fleet: str, member: str) -> Keys:
    """Return the keys in a folder after checking that they are those of *member*, complete, valid today, and private.

    Raises:
        UsageError: a file is missing or unreadable, or does not fit. The text says which, why, and how to fix it.
    """
    ca, certificate, key = (_read(folder / name) for name in (CA, CERTIFICATE, KEY))
    members = tuple(_read(folder / MEMBERS).decode(errors="replace").split())
    _check_private(folder / KEY)
    _check(folder, fleet, member, ca, certificate, key)
    if member not in (*members, "router"):
        raise _wrong(folder / MEMBERS, f"the member `{member}` is missing", f"add a line `{member}`")
    return Keys(folder, members)


def _read(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except FileNotFoundError:
        help = (
            f"copy the whole folder of the member from the computer on which you created it, to {path.parent}"
        )
        raise _wrong(path, "file does not exist", help) from None
    except OSError as error:
        raise _wrong(path, str(error.strerror), f"ls -l {path}") from None


def _check_private(path: Path) -> None:
    if sys.platform != "win32" and path.stat().st_mode & 0o077:
        raise _wrong(path, "other users can read this private key", f"chmod 600 {path}")


def _check(
    folder: Path, fleet: str, member: str, ca_pem: bytes, certificate_pem: bytes, key_pem: bytes
) -> None:
    try:
        from cryptography.hazmat.primitives.serialization import load_pem_private_key
        from cryptography.x509.oid import NameOID
    except ImportError:
        raise UsageError(NO_EXTRA) from None
    again = f"create it again: `jacaros fleet keys {fleet} {member}`, and copy the whole folder"
    ca, certificate = (
        _certificate(folder / CA, ca_pem, again),
        _certificate(folder / CERTIFICATE, certificate_pem, again),
    )
    try:
        key = load_pem_private_key(key_pem, None)
    except (ValueError, TypeError):
        raise _wrong(folder / KEY, "not a private key in PEM format", again) from None
    if key.public_key() != certificate.public_key():
        raise _wrong(folder / KEY, f"not the key of {CERTIFICATE}", again)
    try:
        certificate.verify_directly_issued_by(ca)
    except Exception:  # of several kinds: another name, another kind of key, a wrong signature
        raise _wrong(folder / CERTIFICATE, f"not issued by the authority of {CA}", again) from None
    for oid, what, expected in (
        (NameOID.ORGANIZATION_NAME, "fleet", fleet),
        (NameOID.COMMON_NAME, "member", member),
    ):
        found = [str(each.value) for each in certificate.subject.get_attributes_for_oid(oid)]
        if found != [expected]:
            text = f"expected a certificate for the {what} `{expected}`, found one for `{', '.join(found)}`"
            raise _wrong(folder / CERTIFICATE, text, f"name the folder of the {what} `{expected}`")
    _check_dates(folder / CERTIFICATE, certificate, again)
    _check_dates(folder / CA, ca, again)


def _certificate(path: Path, pem: bytes, help: str) -> "Certificate":
    from cryptography.x509 import load_pem_x509_certificate

    try:
        return load_pem_x509_certificate(pem)
    except ValueError:
        raise _wrong(path, "not a certificate in PEM format", help) from None


def _check_dates(path: Path, certificate: "Certificate", help: str) -> None:
    now, first, last = datetime.now(UTC), certificate.not_valid_before_utc, certificate.not_valid_after_utc
    if now < first:
        text = f"valid from {first:%Y-%m-%d}, and the clock of this computer says {now:%Y-%m-%d}"
        raise _wrong(path, text, "set the clock, such as by NTP")
    if now > last:
        raise _wrong(path, f"expired on {last:%Y-%m-%d}", f"delete the folder and {help}")


def _wrong(path: Path, what: str, help: str) -> UsageError:
    return UsageError(f"error: {path}: {what}\n{help_line(help)}")
