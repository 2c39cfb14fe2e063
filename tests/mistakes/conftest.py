"""The tests read the pages of the documentation as those of `tests/docs` do."""

import sys
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parent.parent / "docs")]
