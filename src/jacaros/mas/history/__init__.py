"""What happened in a run: observers of a running system, the records they make, and answers to questions about them."""

from jacaros.mas.history.explanation import Explanation, Fact
from jacaros.mas.history.history import History, ObservedSystem
from jacaros.mas.history.why import explain

__all__ = ["Explanation", "Fact", "History", "ObservedSystem", "explain"]
