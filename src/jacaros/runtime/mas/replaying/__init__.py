"""Replay a recorded run against a changed program, to see where it decides differently."""

from jacaros.runtime.mas.replaying.differences import Comparison
from jacaros.runtime.mas.replaying.rerun import replay_against

__all__ = ["Comparison", "replay_against"]
