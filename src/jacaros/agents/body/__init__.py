"""The body of an agent, which connects its mind (`jacaros.agents.mind`) to its workspaces (`jacaros.artifacts`)."""
