"""Artifacts from mapping files: a robot for agents without Python.  docs/reference/mapping.md describes the files.

============================================== =======================================================================
file                                           what it holds
============================================== =======================================================================
`declared`                                     what a file says, as data
`file`, `read_*`                               reading it
`interfaces`, `checking`, `manual`             types of messages; what does not fit them; what is told of an artifact
`paths`, `units`, `decoding`, `encoding`       out of messages, and into them
`rows`                                         of a message, or of each element of an array
`artifact`, `host`, `operation_methods`        the class that is made of it
`updaters`, `frames`, `parameters`                properties and signals
`deriving`, `stamped_frames`                   properties and signals composed of events of others; frames at the
                                               stamps of messages
`operating`, `publishing`, `type_search`       operations; types that the file leaves out
============================================== =======================================================================
"""
