"""The internal actions of the language, by family."""
