"""Directives: what `{ name(...) }` and `{ begin name(...) } ... { end }` do to the clauses of a program."""
