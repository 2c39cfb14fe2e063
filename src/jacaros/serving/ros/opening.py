"""Open the door of a run to the ROS graph, as its mapping files say."""

from jacaros.agents.language.offers import USER
from jacaros.robots.mapping.file import MappingError, load_mapping
from jacaros.robots.mapping.offer_codec import OfferCodec, codec_of
from jacaros.runtime.files.yaml import Problem
from jacaros.runtime.mas.mappings import files_with_offers
from jacaros.runtime.mas.system import System
from jacaros.serving.ros.door import RosDoor


def open_door(system: System) -> RosDoor:
    """Offer in the ROS graph what the agents of a started run offer.

    Raises:
        MappingError: a mapping file has errors.
    """
    backend = system.ros.backend()
    codecs: dict[str, OfferCodec] = {}
    roles: list[str] = []
    for path in files_with_offers(system.deployment, system.options.mappings):
        mapping, problems = load_mapping(path), list[Problem]()
        for folder in mapping.interfaces:
            backend.add_interfaces(folder)
        for name, part in mapping.offers.items():
            if (codec := codec_of(part, backend, problems)) is not None:
                codecs[name] = codec
        if problems:
            raise MappingError(mapping.file, mapping.text, problems)
        roles += mapping.roles
    return RosDoor(system, codecs, roles or (USER,))
