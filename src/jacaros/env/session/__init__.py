"""Working sessions: how scripts, behaviour trees and agents in Python use the environment."""
