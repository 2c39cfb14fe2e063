"""Artifacts from mapping files: robots for agents, without Python code.  docs/reference/mapping.md describes the files.

============================================== =======================================================================
file                                           content
============================================== =======================================================================
`declared`                                     the content of a file, as data: parts, paths, conversions
`file`, `read_*`                               reading it; needs neither artifacts nor a middleware
`interfaces`, `checking`, `manual`             message types; checking a mapping against them; documentation
`paths`, `decoding`, `encoding`                reading values from messages, and building messages
`rows`                                         values of a message, or of each element of an array
`artifact`, `host`, `operation_methods`        the class made from a file
`topic_multiplexer`, `frames`, `parameters`    properties and signals
`deriving`, `stamped_frames`                   properties and signals derived from others; frames at the stamps of
                                               messages
`operating`, `publishing`, `type_search`       operations; types that the file omits
============================================== =======================================================================
"""
