"""The HTTP door: REST, server-sent events and WebSockets for what agents offer; needs the extra ``serve``."""
