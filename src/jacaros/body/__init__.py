"""The body of an agent, which connects its mind (`jacaros.bdi`) to its workspaces (`jacaros.env`)."""
