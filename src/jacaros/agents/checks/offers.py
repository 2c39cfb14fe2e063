"""Check what programs offer to callers outside: events that are announced, and values that can be chosen.

>>> from jacaros.agents.language.loader import load_program
>>> program, _ = load_program("robot.asl", "{ offer(event, delivered(parcel)) } +!go <- .announce(deliverd(p1)).")
>>> [each.help for each in wrong_announcements(program, program.found)][0]
'did you mean `delivered/1`?'
"""

from collections.abc import Iterator

from jacaros.agents.checks.beliefs import as_written, is_misspelt
from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import Diagnostic, problem
from jacaros.agents.language.nodes import ByKind, form_of
from jacaros.runtime.files.texts import close_matches, did_you_mean


def wrong_announcements(program: nodes.Program, found: ByKind) -> Iterator[Diagnostic]:
    """Warn of events that are announced but not offered, and of offered events that are never announced."""
    offered = {each.key: each for each in program.offers if each.what == "event"}
    calls = [each for each in found.of(nodes.InternalAction) if each.name == ".announce" and each.arguments]
    announced = {
        _key(each): each for call in calls for each in call.arguments if isinstance(each, nodes.Literal)
    }
    for key, event in announced.items():
        if key not in offered:
            help = did_you_mean(close_matches(key, offered)) or f"write `{{ offer(event, {_form(event)}) }}`"
            yield problem("not-offered", f"event `{key}` is announced, but not offered", event.span, help)
    if any(isinstance(call.arguments[0], nodes.Variable) for call in calls):
        return
    for key, offer in offered.items():
        if key not in announced:
            help = f"announce it: `.announce({as_written(form_of(offer))})`"
            message = f"event `{key}` is offered, but never announced"
            yield problem("unused-offer", message, offer.span, help)


def _key(event: nodes.Literal) -> str:
    return f"{event.functor}/{len(event.arguments)}"


def _form(event: nodes.Literal) -> str:
    """Return an event as an offer declares it, with the names of its variables."""
    names = [
        each.name[:1].lower() + each.name[1:] if isinstance(each, nodes.Variable) else f"value{place}"
        for place, each in enumerate(event.arguments, 1)
    ]
    return f"{event.functor}({', '.join(names)})" if names else event.functor


def misspelt_choices(program: nodes.Program, found: ByKind) -> Iterator[Diagnostic]:
    """Warn of values to choose from that are slips of values that the program uses."""
    lists = [(each, set(parameter.choices)) for each in program.offers for parameter in each.parameters]
    used = {each.functor for each in found.of(nodes.Literal)} | {
        each.value for each in found.of(nodes.String)
    }
    for offer, choices in lists:
        others = used.union(*(other for _, other in lists if other is not choices)) - choices
        for choice in sorted(choices - used):
            meant = sorted(each for each in others if is_misspelt(choice, each))
            if meant:
                message = f"`{choice}` can be chosen for `{offer.key}`, but the program does not know it"
                yield problem("unknown-choice", message, offer.span, did_you_mean(meant[:1]))
