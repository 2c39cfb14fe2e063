"""The colours of a path by time, from its start (blue) to its end (red); the replay page has the same."""

STOPS = ((74, 98, 190), (38, 146, 158), (120, 172, 84), (226, 160, 48), (205, 84, 60))


def colour_at(part: float) -> tuple[int, int, int]:
    """Red, green and blue (0 to 255) at *part* (0 to 1) of the way."""
    place = min(0.9999, max(0.0, part)) * (len(STOPS) - 1)
    index = int(place)
    rest = place - index
    red, green, blue = (
        round(a + (b - a) * rest) for a, b in zip(STOPS[index], STOPS[index + 1], strict=True)
    )
    return red, green, blue
