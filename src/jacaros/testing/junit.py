"""Outcomes as a JUnit XML file, which continuous integration servers show."""

import re
from collections.abc import Sequence
from pathlib import Path
from xml.etree import ElementTree

from jacaros.testing.outcomes import Outcome, SuiteOutcome

_UNFIT = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""Characters that XML cannot hold."""


def write_junit(path: Path, suites: Sequence[SuiteOutcome]) -> None:
    """Write *path*; its folder is made if need be.

    A file whose tests could not be run is one test case with an error.

    Raises:
        OSError: the file cannot be written.
    """
    root = ElementTree.Element("testsuites", _counts(suites), name="jacaros")
    for suite in suites:
        counts = _counts([suite])
        element = ElementTree.SubElement(root, "testsuite", counts, name=str(suite.path))
        if suite.suite.error is not None:
            case = _case(element, suite, "the file", 0.0)
            _text(ElementTree.SubElement(case, "error", message="the file cannot be run"), suite.suite.error)
        for outcome in suite.outcomes:
            _add(element, suite, outcome)
    ElementTree.indent(root)
    path.parent.mkdir(parents=True, exist_ok=True)
    ElementTree.ElementTree(root).write(path, encoding="utf-8", xml_declaration=True)


def _counts(suites: Sequence[SuiteOutcome]) -> dict[str, str]:
    outcomes = [outcome for suite in suites for outcome in suite.outcomes]
    errors = sum(suite.suite.error is not None for suite in suites)
    return {
        "tests": str(len(outcomes) + errors),
        "failures": str(sum(not outcome.passed for outcome in outcomes)),
        "errors": str(errors),
        "skipped": "0",
        "time": f"{sum(outcome.seconds for outcome in outcomes):.3f}",
    }


def _add(element: ElementTree.Element, suite: SuiteOutcome, outcome: Outcome) -> None:
    case = _case(element, suite, outcome.test.name, outcome.seconds)
    case.set("assertions", str(outcome.assertions))
    if outcome.test.span is not None:
        case.set("file", outcome.test.span.file.name)
        case.set("line", str(outcome.test.span.line))
    if outcome.problems:
        failure = ElementTree.SubElement(case, "failure", message=_fit(outcome.problems[0].message))
        _text(failure, "\n".join(line for problem in outcome.problems for line in problem.lines()))
    if outcome.output:
        _text(ElementTree.SubElement(case, "system-out"), "\n".join(outcome.output))


def _case(
    element: ElementTree.Element, suite: SuiteOutcome, name: str, seconds: float
) -> ElementTree.Element:
    group = ".".join(part for part in suite.path.with_suffix("").parts if part not in ("/", "..", "."))
    return ElementTree.SubElement(
        element, "testcase", classname=group, name=name, time=f"{seconds:.3f}", file=str(suite.path)
    )


def _text(element: ElementTree.Element, text: str) -> None:
    element.text = _fit(text)


def _fit(text: str) -> str:
    return _UNFIT.sub("\N{REPLACEMENT CHARACTER}", text)
