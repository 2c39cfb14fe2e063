"""Directives: how `{ name(...) }` and `{ begin name(...) } ... { end }` transform the clauses of a program."""
