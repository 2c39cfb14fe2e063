"""``jacaros version``."""

import platform
from importlib.metadata import PackageNotFoundError, version

import click

_LIBRARIES = ("rosbags", "ruamel.yaml", "click", "rich", "numpy")


@click.command("version")
def command() -> None:
    """Tell the versions of jacaros and of what it uses."""
    click.echo(f"jacaros {_version('jacaros')}")
    click.echo(f"Python {platform.python_version()} on {platform.platform()}")
    for library in _LIBRARIES:
        click.echo(f"{library} {_version(library)}")


def _version(library: str) -> str:
    try:
        return version(library)
    except PackageNotFoundError:
        return "is not installed"
