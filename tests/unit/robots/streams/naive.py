"""The definition of derived events, computed from all events anew for each time: slow, but simple to read."""

from collections.abc import Sequence

from jacaros.robots.streams import Spec, Values

Event = tuple[int, float, Values | None]
"""Number of the stream, time, values."""


def shown(spec: Spec, events: Sequence[Event], now: float) -> Values | None:
    """Return the values that a pattern started at 0 shows at *now*, after the events (in order) of this time."""
    past = [event for event in events if event[1] <= now]
    return _STATES[spec.operator](spec, past, now)


def _count(spec: Spec, past: Sequence[Event], now: float) -> Values | None:
    within = spec.options["within"]
    count = sum(values is not None and now - within < time <= now for _, time, values in past)
    wanted = spec.options.get("at_least")
    if wanted is not None:
        return () if count >= wanted else None
    return (count,) if count else None


def _satisfied(spec: Spec, values: Values | None) -> bool:
    if values is None:
        return False
    above, below, equals = (spec.options.get(each) for each in ("above", "below", "equals"))
    value = values[spec.place]
    assert isinstance(value, float)
    return (
        (above is None or value > above)
        and (below is None or value < below)
        and (equals is None or value == equals)
    )


def _hysteresis(spec: Spec, past: Sequence[Event], now: float) -> Values | None:
    on = False
    options = spec.options
    for _, _, values in past:
        if values is None:
            on = False
            continue
        value = values[spec.place]
        assert isinstance(value, float)
        if "on_above" in options:
            on = value > options["on_above"] or (on and value >= options["off_below"])
        else:
            on = value < options["on_below"] or (on and value <= options["off_above"])
    return () if on else None


def _held(spec: Spec, past: Sequence[Event], now: float) -> Values | None:
    since = None
    for _, time, values in past:
        if not _satisfied(spec, values):
            since = None
        elif since is None:
            since = time
    return () if since is not None and since + spec.options["for"] <= now else None


def _absent(spec: Spec, past: Sequence[Event], now: float) -> Values | None:
    newest = max((time for _, time, values in past if values is not None), default=0.0)
    return () if newest + spec.options["for"] <= now else None


_STATES = {"count": _count, "hysteresis": _hysteresis, "held": _held, "absent": _absent}
