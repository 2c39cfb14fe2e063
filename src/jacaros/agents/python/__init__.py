"""Project extensions in Python: internal actions, arithmetic functions, agent classes.

Projects import these names from `jacaros` itself.
"""
