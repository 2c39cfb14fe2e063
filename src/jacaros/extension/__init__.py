"""Project extensions in Python: internal actions, arithmetic functions, agent classes, belief bases.

Projects import these names from `jacaros` itself.
"""
