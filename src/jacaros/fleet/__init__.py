"""Systems on several computers as one fleet: messages, services and workspaces across processes.

Every system is a *member* of its fleet. The modules, from the network to the system:

======================  ============================================================================
`carrier`               the port to a network: datagrams, and who is present
`on_zenoh`, `network`   the carrier on Eclipse Zenoh, and how its session is configured
`keys`                  certificates and keys of the members
`channel`               all that goes from one member to another: in order, once
`wire`, `protocol`      terms, values and messages of members as bytes
`peer`, `member`        another member, and this one
`agents`, `messages`    agents of other members, and messages in both directions
`served`                workspaces of this member for others
`remote`, `mounted`     those of others, and where they are visible here
`announced`             what this member says of itself
`rights`, `access`      what others may do here: by this system, and by Zenoh
`fleet_artifact`        the members as percepts of agents
`visits`, `operator`    commands that look at members and stop them: how members serve them, and they
======================  ============================================================================
"""
