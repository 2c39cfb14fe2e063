"""``jacaros lsp``: the language server. It needs the extra ``lsp``."""
