"""Working sessions: how scripts, behaviour trees and Python agents use the environment."""
