"""Lets the tests of this folder drive a browser, and builds the site for them."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "unit" / "look"))
