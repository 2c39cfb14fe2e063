"""The certificate authority of a fleet: it issues the certificates of the members, on one computer.

Its private key is needed for new members only. It stays in the folder `authority`, and is never copied to a robot.
"""

import os
import shutil
from collections.abc import Iterable
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path

from jacaros.fleet.keys import CA, CERTIFICATE, KEY, MEMBERS, NO_EXTRA
from jacaros.fleet.names import AUTHORITY, OPERATOR, ROUTER, check_name
from jacaros.runtime.errors import UsageError
from jacaros.runtime.files.texts import help_line

try:
    from cryptography import x509
    from cryptography.hazmat.primitives import hashes, serialization
    from cryptography.hazmat.primitives.asymmetric import ec
    from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID
except ImportError:
    raise UsageError(NO_EXTRA) from None

_VALID = timedelta(days=3650)
_EARLIER = timedelta(days=1)
"""Before the present, for computers with a clock that is late."""


@dataclass(frozen=True, slots=True)
class _Issuer:
    name: x509.Name
    key: ec.EllipticCurvePrivateKey
    last: datetime


def create_keys(folder: Path, fleet: str, members: Iterable[str]) -> list[str]:
    """Create an authority and the keys of routers, the operator and *members*, unless they exist; return the names created.

    Existing keys are kept. All folders get the new list of members.

    Raises:
        UsageError: a name is invalid, or the folder has copied keys but no authority.
    """
    check_name("fleet", fleet)
    wanted = list(dict.fromkeys([OPERATOR, *members]))
    for name in wanted:
        check_name("member", name)
    created = [] if (folder / AUTHORITY).is_dir() else [AUTHORITY]
    if created and folder.is_dir() and any(folder.iterdir()):
        raise UsageError(
            f"error: {folder} has keys, but no authority\n"
            f"{help_line('add members on the computer on which you created the first, or name another --folder')}"
        )
    if created:
        _create_authority(folder, fleet)
    issuer = _read_authority(folder / AUTHORITY)
    for name in (ROUTER, *wanted):
        if not (folder / name).is_dir():
            _create_member(folder, fleet, name, issuer)
            created.append(name)
    _write_members(folder)
    return created


def members_in(folder: Path) -> list[str]:
    """Return the names of the members with keys in the folder of a fleet."""
    found = [each.parent.name for each in folder.glob(f"*/{CERTIFICATE}")]
    return sorted(set(found) - {AUTHORITY, ROUTER})


def _create_authority(folder: Path, fleet: str) -> None:
    key, now = ec.generate_private_key(ec.SECP256R1()), datetime.now(UTC)
    name = _name(fleet, AUTHORITY)
    certificate = (
        _builder(name, key, _Issuer(name, key, now + _VALID))
        .add_extension(x509.BasicConstraints(ca=True, path_length=0), critical=True)
        .add_extension(_usage(signs_certificates=True), critical=True)
        .sign(key, hashes.SHA256())
    )
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    _write_folder(folder / AUTHORITY, {CA: _pem(certificate), KEY: _private_pem(key)})


def _read_authority(folder: Path) -> _Issuer:
    try:
        certificate = x509.load_pem_x509_certificate((folder / CA).read_bytes())
        key = serialization.load_pem_private_key((folder / KEY).read_bytes(), None)
    except (OSError, ValueError) as error:
        raise UsageError(f"error: {folder}: the authority is unreadable: {error}") from None
    assert isinstance(key, ec.EllipticCurvePrivateKey)
    return _Issuer(certificate.subject, key, certificate.not_valid_after_utc)


def _create_member(folder: Path, fleet: str, member: str, issuer: _Issuer) -> None:
    key = ec.generate_private_key(ec.SECP256R1())
    both = [ExtendedKeyUsageOID.CLIENT_AUTH, ExtendedKeyUsageOID.SERVER_AUTH]  # a peer listens and connects
    certificate = (
        _builder(_name(fleet, member), key, issuer)
        .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
        .add_extension(_usage(signs_certificates=False), critical=True)
        .add_extension(x509.ExtendedKeyUsage(both), critical=False)
        .add_extension(x509.SubjectAlternativeName([x509.DNSName(member)]), critical=False)
        .sign(issuer.key, hashes.SHA256())
    )
    ca = (folder / AUTHORITY / CA).read_bytes()
    _write_folder(folder / member, {CA: ca, CERTIFICATE: _pem(certificate), KEY: _private_pem(key)})


def _write_members(folder: Path) -> None:
    names = members_in(folder)
    text = "".join(f"{name}\n" for name in names).encode()
    for name in (ROUTER, *names):
        new = folder / name / f".{MEMBERS}"
        new.write_bytes(text)
        new.replace(folder / name / MEMBERS)


def _name(fleet: str, name: str) -> x509.Name:
    parts = {NameOID.ORGANIZATION_NAME: fleet, NameOID.COMMON_NAME: name}
    return x509.Name([x509.NameAttribute(oid, value) for oid, value in parts.items()])


def _builder(name: x509.Name, key: ec.EllipticCurvePrivateKey, issuer: _Issuer) -> x509.CertificateBuilder:
    now, public = datetime.now(UTC), key.public_key()
    return (
        x509.CertificateBuilder()
        .subject_name(name)
        .issuer_name(issuer.name)
        .public_key(public)
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - _EARLIER)
        .not_valid_after(min(now + _VALID, issuer.last))
        .add_extension(x509.SubjectKeyIdentifier.from_public_key(public), critical=False)
        .add_extension(
            x509.AuthorityKeyIdentifier.from_issuer_public_key(issuer.key.public_key()), critical=False
        )
    )


def _usage(signs_certificates: bool) -> x509.KeyUsage:
    return x509.KeyUsage(
        digital_signature=not signs_certificates,
        content_commitment=False,
        key_encipherment=False,
        data_encipherment=False,
        key_agreement=False,
        key_cert_sign=signs_certificates,
        crl_sign=signs_certificates,
        encipher_only=False,
        decipher_only=False,
    )


def _pem(certificate: x509.Certificate) -> bytes:
    return certificate.public_bytes(serialization.Encoding.PEM)


def _private_pem(key: ec.EllipticCurvePrivateKey) -> bytes:
    return key.private_bytes(
        serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    )


def _write_folder(folder: Path, files: dict[str, bytes]) -> None:
    """Write a whole folder, or none: an interruption leaves no keys that do not fit."""
    new = folder.with_name(f".{folder.name}.new")
    shutil.rmtree(new, ignore_errors=True)
    new.mkdir(mode=0o700)
    for name, content in files.items():
        descriptor = os.open(new / name, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
        with os.fdopen(descriptor, "wb") as file:
            file.write(content)
    new.rename(folder)
