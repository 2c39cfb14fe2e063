"""What a project adds to its agents in Python: internal actions, arithmetic functions, agents, belief bases.

Projects import these names from `jacaros` itself.
"""
