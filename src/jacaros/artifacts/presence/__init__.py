"""What an agent, a script or a behaviour tree has joined, focuses and acts on in an environment."""
