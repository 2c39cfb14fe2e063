"""Why things happened: reasons of failures, contexts that fail, lost goals."""
