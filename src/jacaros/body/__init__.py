"""The body of an agent: it joins a mind (`jacaros.bdi`) to its workspaces (`jacaros.env`)."""
