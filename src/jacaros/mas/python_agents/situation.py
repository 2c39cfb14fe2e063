"""The session of a Python agent at its start."""

from jacaros.artifacts.presence.session import Session
from jacaros.mas.agent_host import AgentHost
from jacaros.mas.deployment import AgentSpec
from jacaros.mas.environment import RunEnvironment
from jacaros.mas.python_agents.host import PythonAgentHost


def situate(host: AgentHost, spec: AgentSpec, where: RunEnvironment) -> None:
    """Give an agent a session, which joins and focuses what the project declares."""
    assert isinstance(host, PythonAgentHost)
    host.open_session = lambda: Session(where.environment, host.name, account=host.task_activity)
    if spec.join or spec.focus:
        where.situate(host.session.presence, spec)
