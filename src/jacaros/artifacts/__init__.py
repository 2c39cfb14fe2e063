"""Ready-made artifacts, and the look-up of artifact types by name.

They depend on `jacaros.env` and `jacaros.ros` only, not on agents, so plain Python programs can use them too.
"""
