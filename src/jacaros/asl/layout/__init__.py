"""Programs in the standard layout: tokens and comments to documents, documents to lines."""
