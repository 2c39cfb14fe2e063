"""Where the lines of an embedded system go: standard streams, callbacks, or the standard logger."""

import logging

import pytest

from jacaros import Mas
from jacaros.runtime.mas.embedding.log_records import log_record

LOGGER = logging.getLogger("jacaros")


async def _play(**options: object) -> None:
    async with Mas(**options) as mas:  # type: ignore[arg-type]
        mas.add_agent("bob", '!go. +!go <- .print(hi); .log(info, fine); .log(warning, careful, 100, "%").')
        await mas.until_idle()


@pytest.fixture
def unconfigured(monkeypatch: pytest.MonkeyPatch) -> None:
    """As in a program that has not configured logging: pytest has, for the root logger."""
    monkeypatch.setattr(LOGGER, "hasHandlers", lambda: False)


@pytest.mark.usefixtures("unconfigured")
async def test_lines_go_to_the_standard_streams_by_default(capsys: pytest.CaptureFixture[str]) -> None:
    await _play()
    shown = capsys.readouterr()
    assert shown.out == "[bob] hi\n"
    assert shown.err == "[bob] info: fine\n[bob] warning: careful100%\n"


async def test_a_program_with_logging_gets_records(
    caplog: pytest.LogCaptureFixture, capsys: pytest.CaptureFixture[str]
) -> None:
    caplog.set_level("INFO", "jacaros")
    await _play()
    records = [(each.name, each.levelname, each.agent, each.getMessage()) for each in caplog.records]  # type: ignore[attr-defined]
    assert records == [
        ("jacaros", "INFO", "bob", "[bob] fine"),
        ("jacaros", "WARNING", "bob", "[bob] careful100%"),
    ]
    assert capsys.readouterr() == ("[bob] hi\n", "")


@pytest.mark.usefixtures("unconfigured")
async def test_a_level_alone_configures_the_logger(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(LOGGER, "level", logging.ERROR)
    await _play()
    assert capsys.readouterr() == ("[bob] hi\n", "")


async def test_a_callback_replaces_the_logger(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level("INFO", "jacaros")
    logs: list[tuple[str, str]] = []
    await _play(on_log=lambda text, level: logs.append((text, level)))
    assert logs == [("[bob] info: fine", "info"), ("[bob] warning: careful100%", "warning")]
    assert not caplog.records


async def test_a_faulty_filter_does_not_stop_the_run(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(record: logging.LogRecord) -> bool:
        raise KeyError(record.name)

    monkeypatch.setattr(LOGGER, "filters", [broken])
    await _play()
    out, err = capsys.readouterr()
    assert out == "[bob] hi\n"
    assert "[bob] warning: careful100%\nerror: an on_log callback raised KeyError: 'jacaros'" in err


@pytest.mark.parametrize(
    ("line", "agent", "message"),
    [
        ("[bob] error: goal lost\n  = help: add a plan", "bob", "[bob] goal lost\n  = help: add a plan"),
        ("[a]b] warning: x", "a]b", "[a]b] x"),
        ("[ros] connected", "ros", "[ros] connected"),
        ("error: out of memory", "", "out of memory"),
        ("<bob>:1:2: warning: unknown plan", "", "<bob>:1:2: warning: unknown plan"),
        ("[1, 2] is a list", "", "[1, 2] is a list"),
        ("", "", ""),
    ],
)
def test_lines_become_messages(caplog: pytest.LogCaptureFixture, line: str, agent: str, message: str) -> None:
    log_record(line, "error")
    (record,) = caplog.records
    assert (record.agent, record.getMessage(), record.levelno) == (agent, message, logging.ERROR)  # type: ignore[attr-defined]
