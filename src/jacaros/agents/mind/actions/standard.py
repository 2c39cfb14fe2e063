"""The internal actions of the language; importing them fills `jacaros.agents.mind.actions.internal_action.STANDARD`."""

from jacaros.agents.mind.actions import agents, beliefs, collections, goals, offered, terms  # noqa: F401 - each registers its actions
