"""Agents in notebooks: programs in cells, the map, tables and recordings below them.

``%load_ext jacaros`` loads `jacaros.notebook.magics`.
"""
