"""Programs in one style: tokens and comments to documents, documents to lines."""
