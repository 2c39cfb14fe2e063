"""An artifact with a defect: one of its steps never ends."""

import time

from jacaros.artifacts import Artifact, operation


class Trap(Artifact):
    """Holds up its process."""

    @operation
    def hang(self) -> None:
        """Tell when it begins, and never end."""
        print(f"hangs {time.time()}", flush=True)
        while True:
            pass
