"""Values of parameters as agents get them: no definition says their type, so what does not fit is seen when it comes."""

import dataclasses
import math

from jacaros.artifacts.mapping.declared import AS_IT_IS, Conversion
from jacaros.artifacts.mapping.taking import Convert, Unshowable, converted
from jacaros.env.values import Atom, text
from jacaros.ros.parameter import ParameterValue


def parameter_converter(conversion: Conversion, name: str) -> Convert:
    """A function that converts the value of a parameter, of a list each element.

    Args:
        conversion: names, units, rounding.
        name: of the parameter, for people.

    The function raises `Unshowable` for what is no number where one is needed.
    """
    convert: Convert = _as_atom if conversion.kind == "atom" else converted(conversion)
    unrounded = converted(dataclasses.replace(conversion, digits=None))
    if conversion == AS_IT_IS:
        return convert
    named = {value for value, _ in conversion.names}
    wants_number = conversion.line is not None or conversion.digits is not None

    def element(value: ParameterValue) -> object:
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        if wants_number and not is_number and not (isinstance(value, str | bool) and value in named):
            told = f"parameter {name} is {text(value, quoted=True)}, no number"
            raise Unshowable(name, told, "leave out its unit, scale, offset and round", "wrong_value")
        # Infinity is no whole number; who takes the value refuses it.
        endless = isinstance(value, float) and not math.isfinite(value)
        return unrounded(value) if endless else convert(value)

    return lambda value: [element(each) for each in value] if isinstance(value, list) else element(value)


def _as_atom(value: ParameterValue) -> object:
    return Atom(value) if isinstance(value, str) else value
