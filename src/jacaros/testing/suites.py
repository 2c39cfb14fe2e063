"""Find agent tests: plans labelled ``test`` in programs and projects.

A plan for an achievement goal whose label has the annotation ``test`` is a test::

    @charges_when_low[test]
    +!test_charging <- ... .

``[test, timeout(2000)]`` sets its time limit in milliseconds; ``[test, mapping("robot.yaml")]`` adds the artifacts of a
mapping file, in a ROS graph without a robot.

In a folder and its subfolders, test files are the programs that contain such a plan, and the projects (`.jcm`, `.mas2j`)
named ``test_...`` or ``..._test``, whose agents are all searched. A program named ``test_...`` or ``..._test`` that
cannot be read is a test file, too.
"""

import os
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Final

from jacaros.agents.checks.formulas import labelled
from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import AslError, Diagnostic, Span, excerpt
from jacaros.agents.language.loader import load_program
from jacaros.agents.language.lowering import format_term
from jacaros.agents.language.nodes import rebuilt
from jacaros.runtime.errors import JacarosError, UsageError
from jacaros.runtime.files.python_modules import ProjectModules
from jacaros.runtime.files.texts import file_text, help_line, is_file
from jacaros.runtime.mas.agents.programs import (
    PROJECTS,
    Programs,
    SourcePath,
    project_folders,
    source_folders,
)
from jacaros.runtime.mas.agents.python_code import PythonCode
from jacaros.runtime.mas.deployment import AgentSpec, Deployment, has_own_artifacts
from jacaros.runtime.mas.launch import load_deployment
from jacaros.testing.assertions import UNTESTED, Assertion

LIBRARY: Final = "tester_agent.asl"
_HARNESS_GOAL: Final = "execute_test_plans"
_LABELLED: Final = re.compile(r"@[\w.]*\s*\[[^\]]*\btest\b")
_COMMENT: Final = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)
_NAMED_TEST: Final = re.compile(r"test_.*|.*_test")


@dataclass(frozen=True)
class AgentTest:
    """One test.

    Attributes:
        name: label of the plan, or the goal if the plan has no label of its own.
        agent: name of the agent that receives the goal.
        goal: goal to achieve.
        span: place of the plan.
        timeout: time limit in seconds; None for the default.
        mappings: mapping files whose artifacts the run creates.
    """

    name: str
    agent: str
    goal: nodes.Literal
    span: Span | None
    timeout: float | None = None
    mappings: tuple[str, ...] = ()


@dataclass
class Suite:
    """The tests of one program or project.

    Attributes:
        path: path of the file.
        tests: tests in the order of the program.
        deployment: what to run for each test; None if the file has errors.
        error: why the file cannot be run.
        warnings: warnings about its programs.
    """

    path: Path
    tests: list[AgentTest] = field(default_factory=list)
    deployment: Deployment | None = None
    error: str | None = None
    warnings: list[str] = field(default_factory=list)


def with_assertions(program: nodes.Program) -> nodes.Program:
    """Return a program prepared for tests: with all assertion goals, without the initial goal of Jason's test harness."""
    labels = set(map(_label, program.plans)) - {None}
    added = tuple(plan for plan in _library() if _label(plan) not in labels)
    goals = tuple(goal for goal in program.goals if goal.functor != _HARNESS_GOAL)
    return replace(program, goals=goals, plans=(*program.plans, *added))


@cache
def _library() -> tuple[nodes.Plan, ...]:
    """Return the assertion goals, and the rest of Jason's test harness."""
    library = SourcePath(())
    return load_program(*library.include(f"$jacaros/{LIBRARY}", "<tests>"), library.include)[0].plans


def collect(paths: Sequence[Path]) -> list[Suite]:
    """Return the suites in files and folders, in order and without repetition.

    Files that cannot be read become suites with a `Suite.error`.

    Raises:
        UsageError: a path does not exist, or is not a program, a project or a folder.
    """
    found: dict[Path, Suite] = {}
    for path in paths:
        for suite in _in_folder(path) if os.path.isdir(path) else [_of_file(path)]:
            found.setdefault(suite.path.resolve(), suite)
    _without_repetitions(found.values())
    return list(found.values())


def suite_of(path: Path) -> Suite:
    """Return the suite of one program or project file."""
    suite = Suite(path)
    try:
        deployment = load_deployment(path) if path.suffix in PROJECTS else _lone(path)
        texts = _programs(deployment, suite.warnings.append)
        problems: list[Diagnostic] = []
        declared: set[str] = set()
        for spec, program in zip(deployment.agents, texts, strict=True):
            if spec.declared_name not in declared:
                declared.add(spec.declared_name)
                suite.tests += _tests(spec.name, program, problems)
        suite.warnings += [each.render() for each in problems if each.severity == "warning"]
        wrong = [each for each in problems if each.severity == "error"]
        if wrong:
            raise AslError(wrong)
        suite.deployment = deployment
    except JacarosError as fault:
        suite.tests.clear()
        suite.error = str(fault)
    return suite


def is_test_file(path: Path) -> bool:
    """Return whether a program or project in a folder is a test file; see the module docstring."""
    named = bool(_NAMED_TEST.fullmatch(path.stem))
    if path.suffix in PROJECTS:
        return named
    if path.suffix != ".asl":
        return False
    try:
        text = file_text(path)
    except (OSError, UnicodeError):
        return named
    return bool(_LABELLED.search(_COMMENT.sub("", text))) or (named and suite_of(path).error is not None)


def _in_folder(folder: Path) -> list[Suite]:
    files: list[Path] = []
    for place, folders, names in os.walk(folder):
        folders[:] = sorted(name for name in folders if not name.startswith((".", "__")))
        files += filter(is_test_file, (Path(place) / name for name in sorted(names)))
    suites = [suite_of(file) for file in files if file.suffix in PROJECTS]
    # Programs that a test project runs are not run again as single programs.
    run = {
        spec.source_path.resolve()
        for suite in suites
        if suite.deployment is not None
        for spec in suite.deployment.agents
    }
    suites += [suite_of(file) for file in files if file.suffix == ".asl" and file.resolve() not in run]
    return sorted(suites, key=lambda suite: suite.path)


def _of_file(path: Path) -> Suite:
    if path.suffix not in (".asl", *PROJECTS):
        help = help_line("expected .asl, .mas2j, .jcm or a folder")
        raise UsageError(f"error: unsupported file type: `{path}`\n{help}")
    if not is_file(path):
        raise UsageError(f"error: file not found: `{path}`")
    return suite_of(path)


def _without_repetitions(suites: Iterable[Suite]) -> None:
    """Drop tests from included files that are suites themselves."""
    programs = {suite.path.resolve(): suite for suite in suites if suite.path.suffix == ".asl"}
    for path, suite in programs.items():
        others = programs.keys() - {path}
        suite.tests = [
            each
            for each in suite.tests
            if each.span is None or Path(each.span.file.name).resolve() not in others
        ]


# programs


def _programs(deployment: Deployment, warn: Callable[[str], None]) -> list[nodes.Program]:
    """Read the programs of all agents.

    Raises:
        AslError: with the errors of all programs.
    """
    code = PythonCode(ProjectModules(deployment.base_path, *deployment.source_paths))
    code.actions.update(UNTESTED)
    programs = Programs(deployment.source_paths, warn, code, lambda program, _: with_assertions(program))
    return programs.load_all(deployment.agents)


def _lone(path: Path) -> Deployment:
    """Return the deployment of a single program; its project is searched in the folders above."""
    folders = project_folders(path.parent)
    base = next((folder for folder in folders if has_own_artifacts(folder)), folders[-1])
    agent = AgentSpec(path.stem, path, path.stem)
    sources = source_folders(path.parent, above=folders[1:])
    return Deployment(path.stem, base, (agent,), artifact_environment=True, source_paths=sources)


def _tests(agent: str, program: nodes.Program, problems: list[Diagnostic]) -> Iterator[AgentTest]:
    known: dict[str, nodes.Plan] = {}
    for plan in program.plans:
        if not _marks(plan, "test"):
            continue
        literal = plan.trigger.literal
        if plan.trigger.operator + plan.trigger.kind != "+!" or not isinstance(literal, nodes.Literal):
            help = "as in @name[test] +!goal <- ..."
            problems.append(Diagnostic("error", "a test is a plan for a goal", plan.span, help))
            continue
        goal = nodes.replace(literal, annotations=None)
        signature = _signature(goal)
        first = known.setdefault(signature, plan)
        if first is not plan:
            # Several plans for one goal are alternatives of one test, unless the first one is always applicable.
            if first.context is not None:
                continue
            message = f"unreachable test: an earlier plan for !{signature} is always applicable"
            problems.append(Diagnostic("warning", message, plan.span, "give the test a different goal"))
        label = _label(plan)
        name = goal.functor if label is None or label.startswith("p__") else label
        mappings = tuple(_mappings(plan, problems))
        yield AgentTest(name, agent, goal, plan.span, _timeout(plan), mappings)


def _marks(plan: nodes.Plan, functor: str) -> list[nodes.Literal]:
    """Return the annotations of a plan's label with that functor."""
    return [annotation for annotation in labelled(plan) if annotation.functor == functor]


def _timeout(plan: nodes.Plan) -> float | None:
    for mark in _marks(plan, "timeout"):
        match mark.arguments:
            case (nodes.Number(value=milliseconds),):
                return milliseconds / 1000.0
    return None


def _mappings(plan: nodes.Plan, problems: list[Diagnostic]) -> Iterator[str]:
    """Yield the mapping files of a test: next to its file, in the current folder, or shipped with the package."""
    for mark in _marks(plan, "mapping"):
        for argument in mark.arguments or (None,):
            if not isinstance(argument, nodes.String):
                help = 'as in @name[test, mapping("robot.yaml")]'
                problems.append(Diagnostic("error", "mapping(...) expects a file name", plan.span, help))
                continue
            beside = Path(plan.span.file.name).parent / argument.value if plan.span is not None else None
            yield str(beside) if beside is not None and is_file(beside) else argument.value


def _label(plan: nodes.Plan) -> str | None:
    return plan.label.functor if isinstance(plan.label, nodes.Literal) else None


def _signature(goal: nodes.Literal) -> str:
    """Return the goal as text, with all variables written alike."""
    return format_term(rebuilt(goal, lambda node: _ANY if isinstance(node, nodes.Variable) else node))


_ANY: Final = nodes.Variable("_")


# Outcomes of tests.


@dataclass(frozen=True, slots=True)
class FailureReport:
    """One reason why a test failed.

    Attributes:
        message: the error, in one line.
        details: further lines, such as the expected value.
        span: place in the program; None if unknown.
    """

    message: str
    details: tuple[str, ...] = ()
    span: Span | None = None

    @staticmethod
    def of(assertion: Assertion) -> "FailureReport":
        """Return the problem for a failed assertion."""
        details = []
        if assertion.expected:
            details.append(f"expected  {assertion.expected}")
        if assertion.actual:
            details.append(f"{'but' if assertion.expected else 'because':9} {assertion.actual}")
        return FailureReport(f"{assertion.name} failed", tuple(details), assertion.span)

    def lines(self) -> list[str]:
        """Return the problem as text: place and message, source line, details."""
        details = [f"  {detail}" for detail in self.details]
        if self.span is None:
            return [self.message, *details]
        place = f"{self.span.file.name}:{self.span.line}:{self.span.column}"
        return [f"{place}: {self.message}", *excerpt(self.span), *details]


@dataclass(slots=True)
class Outcome:
    """The outcome of one test.

    Attributes:
        problems: reasons for the failure; empty if the test passed.
        assertions: number of assertions evaluated.
        output: output of agents and log lines, in order.
        seconds: duration on the wall clock.
        simulated: duration on the clock of the run, in seconds.
    """

    test: AgentTest
    problems: list[FailureReport] = field(default_factory=list)
    assertions: int = 0
    output: list[str] = field(default_factory=list)
    seconds: float = 0.0
    simulated: float = 0.0

    @property
    def passed(self) -> bool:
        """Whether the test passed."""
        return not self.problems

    def lines(self) -> list[str]:
        """Return all problems and the output as text."""
        found = [line for problem in self.problems for line in problem.lines()]
        if self.output:
            found += ["printed:", *(f"  {line}" for text in self.output for line in text.splitlines())]
        return found
