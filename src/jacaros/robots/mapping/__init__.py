"""Artifacts from mapping files: robots for agents, without Python code.  docs/reference/mapping.md describes the files.

======================= =====================================================================================
file                    content
======================= =====================================================================================
`fields`                the content of a file and how it is read: names, paths, fields, conversions,
`properties`            what agents perceive,
`operations`            what they do,
`file`                  and whole artifacts; needs neither artifacts nor a middleware
`interfaces`            message types: fields, paths through them, constants, units
`checking`, `manual`    checking a mapping against message types; documentation
`decoding`, `encoding`  values and rows of values from messages; messages from values
`artifact`, `host`      the class made from a file; types that the file omits
`mapped_topic`          properties and signals from topics
`frames`, `parameters`  properties from tf and from parameters of nodes
`deriving`              properties derived from others
`operating`             operations
======================= =====================================================================================
"""
