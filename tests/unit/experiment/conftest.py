"""Lets tests import the scripts of the experiment."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[3] / "experiment"))
