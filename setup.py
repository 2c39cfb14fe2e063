"""What pyproject.toml cannot say: licence and README for package indexes, and an ament_python package for colcon."""

import re
from pathlib import Path
from typing import Any

import setuptools

ROOT = Path(__file__).parent
VERSION = re.search(r'VERSION = "(.+)"', (ROOT / "src/jacaros/version.py").read_text(encoding="utf-8"))[1]  # type: ignore[index]
REPOSITORY = "https://github.com/jacaros/jacaros"


def long_description() -> str:
    """Return README with absolute addresses: an index shows it beside no files."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    text = re.sub(r'(?<=src=")(?!https?:)', f"{REPOSITORY}/raw/v{VERSION}/", text)
    return re.sub(r"(?<=\]\()(?!https?:|#)", f"{REPOSITORY}/blob/v{VERSION}/", text)


class Distribution(setuptools.Distribution):
    """A distribution that colcon can read: it prints all attributes and takes what is printed for Python literals."""

    def parse_config_files(self, *arguments: Any, **options: Any) -> None:
        """Read pyproject.toml, of which one value becomes an object that has no literal."""
        # In pyproject.toml this would be refused by setuptools before 77, which ROS 2 Jazzy's colcon builds with.
        field = "license_expression" if hasattr(self.metadata, "license_expression") else "license"
        setattr(self.metadata, field, "Apache-2.0")
        self.metadata.long_description = long_description()
        self.metadata.long_description_content_type = "text/markdown"
        super().parse_config_files(*arguments, **options)
        self.python_requires = self.metadata.python_requires = str(self.python_requires)


setuptools.setup(
    distclass=Distribution,
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/jacaros"]),
        ("share/jacaros", ["package.xml"]),
    ],
)
