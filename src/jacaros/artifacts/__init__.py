"""Ready-made artifacts, and the look-up of artifact types by name.

They join `jacaros.env` and `jacaros.ros` and know nothing of agents: plain Python can use them as well.
"""
