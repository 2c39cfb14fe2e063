"""Artifacts from mapping files: a robot for agents without Python.  docs/reference/mapping.md describes the files.

================================================ =====================================================================
file                                             what it holds
================================================ =====================================================================
`declared`                                       what a file says, as data
`file`, `read_*`                                 reading it
`paths`, `units`, `taking`, `filling`            out of messages, and into them
`extracting`, `interfaces`, `checking`           rows of a message; types; what does not fit them
`artifact`, `host`, `operation_methods`          the class that is made of it
`feeds`, `elements`, `frames`, `*_parameters`    properties and signals
`operating`, `publishing`, `type_search`         operations; types that the file leaves out
`manual`, `known_types`, `errors`, `handle`      what is told about it; big things by reference
================================================ =====================================================================
"""
