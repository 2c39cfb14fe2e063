"""Events composed of events: incremental operators over timestamped streams.

docs/reference/derived_events.md defines them.

============================================== =======================================================================
file                                           what it holds
============================================== =======================================================================
`schema`                                       operators with their options; checks of declarations
`pattern`                                      one derived event: puts late events in order, drives an operator
`operator`, `condition`                        the interface and conditions of operators
`counting`                                     the number of events in a sliding window
`states`                                       hysteresis, a condition held for a while
`order`                                        sequence, absence
`together`                                     samples of several streams with nearby stamps
============================================== =======================================================================

The package has no clock: the host passes times, and calls `Pattern.advance` at `Pattern.deadline`.
"""
