"""Systems on several computers as one fleet: messages, services and workspaces across processes.

Every system is a *member* of its fleet. The modules, from the network to the system:

======================  ============================================================================
`carrier`               the port to a network: datagrams, and who is present
`on_zenoh`, `network`   the carrier on Eclipse Zenoh, and how its session is configured
`keys`                  certificates and keys of the members
`channel`               all that goes from one member to another: in order, once
`wire`, `protocol`      terms, values and messages of members as bytes
`peer`, `member`        another member, and this one
`agents`, `services`    agents of other members, and what they provide
`served`, `remote`      workspaces of this member for others, and those of others
`fleet_artifact`        the members as percepts of agents
`visits`, `operator`    commands that look at members and stop them: how members serve them, and they
======================  ============================================================================
"""
