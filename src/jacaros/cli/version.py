"""``jacaros version``."""

import platform
from importlib.metadata import PackageNotFoundError, version

import click

_LIBRARIES = ("click", "rich", "ruamel.yaml", "websockets", "numpy")


@click.command("version")
def command() -> None:
    """Print the versions of jacaros and its dependencies."""
    click.echo(f"jacaros {version_of('jacaros')}")
    click.echo(f"Python {platform.python_version()} on {platform.platform()}")
    for library in _LIBRARIES:
        click.echo(f"{library} {version_of(library)}")


def version_of(library: str) -> str:
    """Return the version of an installed package, or "is not installed"."""
    try:
        return version(library)
    except PackageNotFoundError:
        return "is not installed"
