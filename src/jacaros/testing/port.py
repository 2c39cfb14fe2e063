"""Port of an agent under test to its harness."""

from asyncio import CancelledError
from collections.abc import Callable, Collection, Coroutine, Mapping, Sequence
from pathlib import Path
from random import Random
from typing import Any

from jacaros.bdi.mind import Mind
from jacaros.bdi.state.act import Act
from jacaros.bdi.state.speech_act import SpeechAct
from jacaros.clock import Timer, VirtualClock, run
from jacaros.errors import UsageError
from jacaros.mas.coroutines import Ended, without_exit
from jacaros.mas.programs import Programs
from jacaros.testing.recorded import Action, RecordedAct, SentMessage


class HarnessPort:
    """The agent's port to its host (`jacaros.bdi.architecture.Architecture`), which records what the agent does.

    Attributes:
        mind: the agent.
        mistake: first exception of a function that answers actions, which for the agent is only a failed step.
    """

    mind: Mind

    def __init__(
        self,
        name: str,
        actions: Mapping[str, Action],
        others: Collection[str] | None,
        seed: int,
        programs: Programs,
        file: Path,
    ) -> None:
        self.random = Random(seed)
        self.clock = VirtualClock()
        self.prints: list[str] = []
        self.logs: list[str] = []
        self.acts: list[RecordedAct] = []
        self.sent: list[SentMessage] = []
        self.files: dict[str, str] = {}
        self.exit_code: int | None = None
        self.mistake: Exception | None = None
        self._name, self._actions, self._others = name, actions, others
        self._programs, self._file = programs, file
        self._by_number: dict[int, RecordedAct] = {}
        self._services: list[str] = []

    def now(self) -> float:
        return self.clock.now()

    def ready(self) -> None:
        pass

    def set_timer(self, delay: float, callback: Callable[[], None]) -> Timer:
        return self.clock.call_later(delay, callback)

    def start_coroutine(self, coroutine: Coroutine[Any, Any, Any], ended: Ended) -> Timer:
        # Awaiting takes no time in a test: the coroutine runs to its end, which the next check of timers reports.
        result: object = None
        error: BaseException | None = None
        try:
            result = run(lambda: without_exit(coroutine), VirtualClock())
        except (Exception, CancelledError) as wrong:
            error = wrong
        return self.clock.call_later(0.0, lambda: ended(result, error))

    def act(self, act: Act) -> None:
        recorded = self._by_number[act.id] = RecordedAct(act, self.mind.complete)
        self.acts.append(recorded)
        function = self._actions.get(recorded.name)
        if function is not None:
            try:
                recorded.answer(function)
            except Exception as wrong:
                self.mistake = self.mistake or wrong

    def cancel_act(self, act_id: int) -> None:
        act = self._by_number[act_id]
        act.pending, act.cancelled = False, True

    def suspend_act(self, act_id: int) -> None:
        self._by_number[act_id].paused = True

    def resume_act(self, act_id: int) -> None:
        self._by_number[act_id].paused = False

    def send(self, message: SpeechAct) -> bool:
        if message.receiver == self._name:
            self.mind.receive(message)
            return True
        if self._others is not None and message.receiver not in self._others:
            return False
        self.sent.append(SentMessage(message))
        return True

    def agent_names(self) -> Sequence[str]:
        return (self._name, *(self._others or ()))

    def print(self, text: str) -> None:
        self.prints.append(text)

    def log(self, level: str, text: str) -> None:
        self.logs.append(f"{level}: {text}")

    def goal_lost(self) -> None:
        pass

    def out_of_memory(self) -> None:
        self.log("error", "out of memory")

    def stop_system(self, delay: float, exit_code: int) -> None:
        if delay > 0:
            self.mind.shut_down_in(delay * 1000)
            self.clock.call_later(delay, lambda: self.stop_system(0.0, exit_code))
        else:
            self.exit_code = exit_code
            self.mind.stopped = True

    def create_agent(self, name: str, source: str | None, classes: Mapping[str, str]) -> str | None:
        del classes
        self.log("info", f".create_agent({name}, {source}): this test has no other agents")
        return None

    def explain(self, question: str) -> Mapping[str, Any]:
        raise UsageError(f"cannot answer `{question}`: this test has no recording")

    def clone_agent(self, name: str) -> str | None:
        self.log("info", f".clone({name}): this test has no other agents")
        return None

    def kill_agent(self, name: str, delay: float = 0.0) -> bool:
        if name == self._name:
            self.stop_system(delay, 0)
        return name in self.agent_names()

    def read_program(self, path: str) -> tuple[str, str]:
        return self._programs.path.include(path, str(self._file))

    def list_files(self, folder: str) -> Sequence[str]:
        return self._programs.list_files(folder, self._file.parent)

    def write_file(self, path: str, text: str) -> None:
        self.files[path] = text

    def register_service(self, service: str) -> None:
        if service not in self._services:
            self._services.append(service)

    def deregister_service(self, service: str) -> None:
        if service in self._services:
            self._services.remove(service)

    def providers(self, service: str) -> Sequence[str]:
        return [self._name] if service in self._services else []

    def subscribe_to_service(self, service: str) -> None:
        del service
