"""What each member may do, as access rules of Zenoh: none speaks in the name of another one, or hears what is for it.

Each member, and each router, applies these rules to all that comes from a link, and knows who is at its other end by the
certificate. Zenoh matches names in certificates exactly, so the rules list all members. What they do not list is denied,
also to a member that is not in the list.
"""

from collections.abc import Sequence
from typing import Any

from jacaros.fleet.names import ROUTER

_SEEING = ("declare_liveliness_subscriber", "liveliness_query")
_DATAGRAMS = ("put", "declare_subscriber", "liveliness_token", *_SEEING)
"""All kinds of messages that members exchange: there are neither queries nor deletions."""


def access_rules(fleet: str, members: Sequence[str]) -> dict[str, Any]:
    """Return the configuration ``access_control`` of a session.

    Args:
        fleet: name of the fleet.
        members: names of all members. Those of certificates, and of the keys ``jacaros/FLEET/member/NAME``.
    """
    everyone = [ROUTER, *members]
    rules = [_rule("out", "egress", _DATAGRAMS, f"jacaros/{fleet}/**")]
    rules.append(_rule("forward", "ingress", _DATAGRAMS, f"jacaros/{fleet}/**"))
    rules.append(_rule("see", "ingress", _SEEING, f"jacaros/{fleet}/member/**"))
    policies = [
        {"subjects": everyone, "rules": ["out"]},
        {"subjects": [ROUTER], "rules": ["forward"]},
        {"subjects": list(members), "rules": ["see"]},
    ]
    for name in members:
        rules += [
            _rule(f"{name} is there", "ingress", ["liveliness_token"], f"jacaros/{fleet}/member/{name}/**"),
            _rule(f"{name} hears", "ingress", ["declare_subscriber"], f"jacaros/{fleet}/to/{name}/**"),
            _rule(f"{name} speaks", "ingress", ["put"], f"jacaros/{fleet}/to/*/*/from/{name}/**"),
        ]
        own = [f"{name} {does}" for does in ("is there", "hears", "speaks")]
        policies.append({"subjects": [name], "rules": own})
    return {
        "enabled": True,
        "default_permission": "deny",
        "rules": rules,
        "subjects": [{"id": name, "cert_common_names": [name]} for name in everyone],
        "policies": policies,
    }


def _rule(id: str, flow: str, messages: Sequence[str], key: str) -> dict[str, Any]:
    return {
        "id": id,
        "flows": [flow],
        "messages": list(messages),
        "key_exprs": [key],
        "permission": "allow",
    }
