"""Events composed of events: incremental operators over timestamped streams.

docs/reference/derived_events.md defines them.

============================================== =======================================================================
file                                           what it holds
============================================== =======================================================================
`declarations`                                 the operators with their options, their checks; policies of readings
`pattern`                                      one derived event: puts late events in order, drives an operator
`operators`                                    sliding windows, hysteresis, conditions held for a while, absence, samples
                                               with nearby stamps
============================================== =======================================================================

The package has no clock: the host passes times, and calls `Pattern.advance` at `Pattern.deadline`.
"""
