"""Lets tests import the scripts of the experiment."""

import sys
from pathlib import Path

EXPERIMENT = Path(__file__).parents[3] / "experiment"
sys.path[:0] = [str(EXPERIMENT), str(EXPERIMENT / "study")]
