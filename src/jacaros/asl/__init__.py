"""The front end: AgentSpeak text to syntax trees, with messages about what is wrong."""
