"""Values of the language: terms, unification, order, arithmetic, text.  Nothing here knows of agents."""
