"""The internal actions of the language; importing them fills `jacaros.agents.mind.actions.internal_action.STANDARD`."""

from jacaros.agents.mind.actions import (  # noqa: F401 - each registers its actions
    agents,
    beliefs,
    collections,
    explaining,
    goals,
    lists,
    output,
    plans,
    strings,
    terms,
    waiting,
)
