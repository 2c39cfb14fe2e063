"""Values of the language: terms, unification, order, arithmetic, text. This package does not depend on agents."""
