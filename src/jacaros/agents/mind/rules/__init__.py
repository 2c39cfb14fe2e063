"""What the language means: the rules of its semantics."""
