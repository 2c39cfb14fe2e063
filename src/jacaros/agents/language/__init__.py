"""The front end: from AgentSpeak text to syntax trees and diagnostics."""
