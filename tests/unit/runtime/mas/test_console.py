"""The outputs of a run."""

import io

from jacaros.runtime.mas.console import StandardConsole


def test_agents_write_to_the_output_and_logs_to_the_errors() -> None:
    output, errors = io.StringIO(), io.StringIO()
    console = StandardConsole(output=output, errors=errors)
    console.print("ann", "hello")
    console.print("ann", "")
    console.log("[lamp] on")
    assert output.getvalue() == "[ann] hello\n[ann] \n"
    assert errors.getvalue() == "[lamp] on\n"


def test_lines_below_the_level_are_hidden() -> None:
    errors = io.StringIO()
    console = StandardConsole("warning", io.StringIO(), errors)
    console.log("note", "info")
    console.log("beware", "warning")
    console.log("wrong", "error")
    assert errors.getvalue() == "beware\nwrong\n"
