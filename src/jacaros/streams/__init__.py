"""Events composed of events: incremental operators over timestamped streams.

docs/reference/derived_events.md defines them.

============================================== =======================================================================
file                                           what it holds
============================================== =======================================================================
`schema`                                       operators with their options; checks of declarations
`pattern`                                      one derived event: puts late events in order, drives an operator
`operator`, `condition`                        the interface and conditions of operators
`counting`, `aggregates`, `share`              sliding windows
`states`, `area`                               hysteresis, debounce, held, delayed; inside an area
`order`                                        sequence, absence
`joining`                                      samples of several streams, for the two that join them by their times:
`together`, `interpolated`                     samples with nearby stamps; values at the stamps of another stream
============================================== =======================================================================

The package has no clock: the host passes times, and calls `Pattern.advance` at `Pattern.deadline`.
"""
