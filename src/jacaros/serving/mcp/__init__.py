"""The MCP door: what agents offer, as tools and resources for language models; needs the extra ``mcp``."""
