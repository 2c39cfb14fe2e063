"""What happened in a run: observers of a running system, and the records they make."""

from jacaros.mas.history.history import History, ObservedSystem

__all__ = ["History", "ObservedSystem"]
