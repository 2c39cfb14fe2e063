"""The session of a Python agent at its start."""

from jacaros.env.environment import Environment
from jacaros.env.errors import OperationFailed, UnknownArtifact
from jacaros.env.session.session import Session
from jacaros.mas.agent_host import AgentHost
from jacaros.mas.deployment import AgentSpec, FocusSpec
from jacaros.mas.environment import artifact_of, path_of
from jacaros.mas.python_agents.host import PythonAgentHost


def situate(host: AgentHost, spec: AgentSpec, environment: Environment) -> None:
    """Give an agent a session that has joined and focused what the project declares.

    An artifact that does not exist is focused as soon as it is created. Other errors are logged.
    """
    assert isinstance(host, PythonAgentHost)
    host.open_session = lambda: Session(environment, host.name, account=host.task_activity)
    try:
        for workspace in spec.join:
            host.session.join(path_of(environment, workspace))
        for focus in spec.focus:
            _focus(host, environment, focus)
    except OperationFailed as failure:
        host.log("error", failure.message)


def _focus(host: PythonAgentHost, environment: Environment, wanted: FocusSpec) -> None:
    if wanted.workspace is None:
        host.session.focus(artifact_of(environment, wanted))
        return
    path = f"{path_of(environment, wanted.workspace)}/{wanted.artifact}"
    try:
        host.session.focus(path)
    except UnknownArtifact:
        host.start(host.session.focus_when_available(path))
