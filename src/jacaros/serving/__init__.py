"""What agents offer to callers outside: goals, beliefs, questions and events, the same for each door."""
