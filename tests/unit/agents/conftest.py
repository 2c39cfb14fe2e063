"""Lets all tests of agents run minds on the host of `mind`: test folders are not packages."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "mind"))
