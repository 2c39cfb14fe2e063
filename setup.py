"""Lets colcon build this repository as an ament_python package; everything else stands in pyproject.toml."""

from setuptools import setup

setup(
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/jacaros"]),
        ("share/jacaros", ["package.xml"]),
    ],
)
