"""Signs of life of an action server: when silence means that it is gone."""

import pytest

from jacaros.robots.ros.protocols import ros2_actions
from jacaros.robots.ros.protocols.ros2_actions import FailureDetector


class Watched:
    """A watch over a server, with a clock that stands still between steps."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now = 100.0
        self.probes = 0
        self.looks = 0
        self.told: list[bool] = []
        monkeypatch.setattr(ros2_actions.time, "monotonic", lambda: self.now)
        self.detector = FailureDetector(self._probed, self.told.append, self._look)
        self.answering = True
        self.telling = False

    def _probed(self) -> None:
        self.probes += 1

    def _look(self) -> None:
        self.looks += 1

    def live(self, seconds: float, under_way: bool = True, waiting: bool = False) -> None:
        """Let time pass: the server answers what it is asked, or not."""
        for _ in range(round(seconds / 0.1)):
            self.now += 0.1
            asked = self.probes
            self.detector.check(self.now, under_way, waiting)
            if self.answering and self.probes > asked:
                self.detector.heard()
                self.detector.probe_answered()
            if self.telling:
                self.detector.heard()


@pytest.fixture
def watched(monkeypatch: pytest.MonkeyPatch) -> Watched:
    made = Watched(monkeypatch)
    made.detector.heard()
    made.detector.goal_begins()
    return made


def test_a_silent_server_that_answers_is_not_suspected(watched: Watched) -> None:
    watched.live(20.0)
    assert watched.told == []
    assert 10 < watched.probes < 25


def test_a_server_that_reports_is_rarely_polled(watched: Watched) -> None:
    watched.telling = True
    watched.live(20.0)
    assert (watched.told, watched.probes) == ([], 1)


def test_a_server_that_falls_silent_is_suspected(watched: Watched) -> None:
    watched.live(3.0)
    watched.answering = False
    watched.live(3.0)
    assert watched.told == [False]


def test_a_server_that_never_answers_while_it_works_is_not_suspected(watched: Watched) -> None:
    watched.answering = False
    watched.live(60.0)
    assert (watched.told, watched.probes) == ([], 1)


def test_an_answer_that_waited_for_the_end_of_the_goal_proves_nothing(watched: Watched) -> None:
    watched.answering = False
    watched.live(5.0)
    watched.detector.heard()
    watched.detector.probe_answered()
    watched.live(0.2)
    watched.detector.rest()
    watched.detector.goal_begins()
    watched.live(30.0)
    assert watched.told == []


def test_a_suspicion_that_was_wrong_is_taken_back_and_not_repeated(watched: Watched) -> None:
    watched.live(3.0)
    watched.answering = False
    watched.live(3.0)
    watched.detector.heard()
    watched.live(30.0)
    assert watched.told == [False, True]


def test_another_server_starts_without_suspicion(watched: Watched) -> None:
    watched.live(3.0)
    watched.detector.reset()
    watched.answering = False
    watched.live(30.0)
    assert watched.told == []


def test_a_silent_server_without_history_gets_a_liveness_check(watched: Watched) -> None:
    watched.answering = False
    watched.live(2.0)
    assert (watched.looks, watched.told) == (1, [])
    watched.detector.looked(found=False)
    assert watched.told == [False]
    watched.detector.looked(found=True)
    assert watched.told == [False, True]


def test_a_server_that_was_found_is_believed_for_a_while(watched: Watched) -> None:
    watched.answering = False
    watched.live(2.0)
    watched.detector.looked(found=True)
    watched.live(25.0)
    assert (watched.looks, watched.told) == (1, [])
    watched.live(25.0)
    assert watched.looks == 2


def test_a_message_during_the_liveness_check_overrides_it(watched: Watched) -> None:
    watched.answering = False
    watched.live(2.0)
    watched.detector.heard()
    watched.detector.looked(found=False)
    assert watched.told == []


def test_an_answering_server_is_not_checked_before_it_is_silent(watched: Watched) -> None:
    watched.live(20.0)
    assert watched.looks == 0
    watched.answering = False
    watched.live(3.0)
    assert (watched.looks, watched.told) == (1, [False])
    watched.detector.looked(found=True)
    assert watched.told == [False, True]


def test_a_server_that_neither_accepts_nor_rejects_is_checked(watched: Watched) -> None:
    watched.answering = False
    watched.live(0.9, under_way=False, waiting=True)
    assert watched.looks == 0
    watched.live(0.5, under_way=False, waiting=True)
    assert (watched.looks, watched.probes) == (1, 0)
    watched.detector.looked(found=False)
    assert watched.told == [False]
