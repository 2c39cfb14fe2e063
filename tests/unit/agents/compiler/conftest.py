"""Lets the tests of generated code run minds on the host of the tests of `bdi`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "mind"))
