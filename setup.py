"""Lets colcon build this repository as an ament_python package; everything else stands in pyproject.toml."""

from typing import Any

import setuptools


class Distribution(setuptools.Distribution):
    """A distribution that colcon can read: it prints all attributes and takes what is printed for Python literals."""

    def parse_config_files(self, *arguments: Any, **options: Any) -> None:
        """Read pyproject.toml, of which one value becomes an object that has no literal."""
        super().parse_config_files(*arguments, **options)
        self.python_requires = self.metadata.python_requires = str(self.python_requires)


setuptools.setup(
    distclass=Distribution,
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/jacaros"]),
        ("share/jacaros", ["package.xml"]),
    ],
)
