"""Single mistakes in a program, of the kinds that people make: each changes one place of one line.

A mistake that changes nothing is not one. The rules, which look at the texts only and never at what `check` finds:

* unread: a belief is added under another name or with other arguments, or a property of a mapping gets another unit, and
  no other place of the project has its name;
* unmatched: an atom becomes a string that is only printed or passed to an artifact (which takes both), or that is nowhere
  else, so nothing is compared with it;
* unobserved: a focus is dropped, and the programs have no name that the artifact may show; artifacts in Python are
  searched for the word. Operations need no focus, but an agent joins the workspace of an artifact by focusing it: a focus
  in a project file is dropped without effect only if the workspace is `main` or the agent focuses another artifact there;
* pace: a time to wait is dropped outside of a loop, or in one that counts to its end; or a condition to wait for whose
  beliefs the plan does not ask for later, or only after an operation with a duration, which gives them time to come;
* both: the goal or operation is there with the other number of arguments, too;
* apart: the changed file belongs to the page or folder, but not to the checked program;
* ignored: the file switches off the finding that reports this kind.
"""

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from pathlib import Path
from tempfile import TemporaryDirectory

from pages import ROOT
from programs import Program

from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import AslError, SourceFile
from jacaros.agents.language.loader import read_program
from jacaros.agents.language.nodes import Node, nodes_in, occurrences, parts_of, walk
from jacaros.artifacts.env.manual import describe
from jacaros.robots.registry import UnknownArtifactType, find_type
from jacaros.runtime.mas.checks.files import check_files

MAPPINGS = ROOT / "src/jacaros/robots/mappings"
LIBRARY = ROOT / "src/jacaros/agents/language/library"
PRINTING = frozenset({".print", ".println", ".printf"})
SWAPPED = {
    "urgency": "urgent",
    "needs": "need",
    "within": "timeout",
    "retry": "retries",
    "every": "period",
    "achieves": "achieve",
    "hard_deadline": "deadline",
    "error_msg": "error_message",
    "env_failure_reason": "failure_reason",
    "source": "sender",
    "artifact_name": "artifact",
    "wsp": "workspace",
}
REPORTED_BY = {"rename-variable": "singleton-variable"}
"""Kinds that a single finding reports, with its code: a file can switch it off."""


@dataclass(frozen=True)
class Mistake:
    """A mutated line.

    Attributes:
        program: the name of the program or project.
        file: the file of it.
        kind: the kind of the mistake.
        line: the number of the line.
        before, after: the line without the space around it.
        equal: the rule by which it changes nothing; empty if it changes something.
    """

    program: str
    file: str
    kind: str
    line: int
    before: str
    after: str
    equal: str = ""


@dataclass(frozen=True)
class Edit:
    """A replacement in a line; columns count from 0."""

    kind: str
    line: int
    start: int
    end: int
    text: str
    equal: str = ""


def mistakes(program: Program) -> Iterator[Mistake]:
    """Yield all mistakes that the kinds make of a program."""
    files = program.files()
    checked = checked_files(program)
    project = Project(files, [name for name in program.mutable(files) if name.endswith(".asl")])
    for name in program.mutable(files):
        lines = files[name].split("\n")
        is_program = name.endswith(".asl")
        others = chain(dropped_focus(lines, project), units(lines, project))
        for edit in project.edits(name) if is_program else others:
            before = lines[edit.line - 1]
            after = before[: edit.start] + edit.text + before[edit.end :]
            equal = edit.equal or ("" if name in checked else "apart") or _ignored(edit.kind, files[name])
            yield Mistake(program.name, name, edit.kind, edit.line, before.strip(), after.strip(), equal)


def checked_files(program: Program) -> set[str]:
    """Return the names of the files that `check` reads when it checks a program."""
    with TemporaryDirectory() as name:
        folder = Path(name).resolve()
        program.write(folder)
        own = [str(folder / each) if (folder / each).is_file() else each for each in program.mappings]
        read = check_files([folder / program.entry], own).files
        found = {path.resolve() for path in read} | {
            folder / each for each in (program.entry, *program.mappings)
        }
        return {path.relative_to(folder).as_posix() for path in found if path.is_relative_to(folder)}


def _ignored(kind: str, text: str) -> str:
    switched_off = re.findall(r"^// jacaros: ignore-file (.*)", text, re.MULTILINE)
    return "ignored" if REPORTED_BY.get(kind) in re.findall(r"[\w-]+", " ".join(switched_off)) else ""


def slip(name: str) -> str:
    """Return a misspelt name: two letters change places, or one is missing."""
    for at in range(len(name) // 2, 0, -1):
        one, two = name[at : at + 2].ljust(2, "_")
        if one != two and (one + two).isalpha():
            return name[:at] + two + one + name[at + 2 :]
    return name[:-1] if len(name) > 1 else name + name


def _other_case(name: str) -> str:
    return name[0].swapcase() + name[1:]


def shown_by(kind: str, files: dict[str, str]) -> set[str]:
    """Return the names of the properties and signals of an artifact type, of a mapping or in Python."""
    if kind.endswith(".yaml"):
        shipped = MAPPINGS / kind
        text = files.get(kind) or (shipped.read_text(encoding="utf-8") if shipped.is_file() else "")
        sections = re.findall(
            r"^(?:properties|signals|derived|frames):.*\n((?:(?: .*)?\n)*)", text, re.MULTILINE
        )
        return {name for section in sections for name in re.findall(r"^  (\w+):", section, re.MULTILINE)}
    own = [text for name, text in files.items() if name.endswith(".py") and f"class {kind}(" in text]
    if own:
        return set(re.findall(r"(?:define_property|signal)\(\s*\"(\w+)\"", own[0]))
    try:
        found = find_type(kind)
    except UnknownArtifactType:
        return set()
    manual = describe(found)
    return {each.name for each in (*manual.properties, *manual.signals)}


class Project:
    """The programs of a project, with what the rules ask about all of them."""

    def __init__(self, files: dict[str, str], programs: list[str]) -> None:
        self.files = files
        self.programs = {name: self._read(name) for name in programs}

    def _read(self, name: str) -> nodes.Program:
        def include(path: str, _: str) -> tuple[str, str]:
            if path.startswith("$jacaros/"):
                return path, (LIBRARY / path.partition("/")[2]).read_text(encoding="utf-8")
            raise FileNotFoundError(path)

        program, found = read_program(SourceFile(name, self.files[name]), include)
        errors = [each for each in found if each.severity == "error"]
        if errors:
            raise AslError(errors)
        return program

    @cached_property
    def literals(self) -> list[nodes.Literal]:
        """All literals of all programs."""
        roots = [(each.beliefs, each.goals, each.plans) for each in self.programs.values()]
        return list(nodes_in(nodes.Literal, tuple(roots)))

    @cached_property
    def read(self) -> Counter[str]:
        """How often names are anything but a fact, or what a step adds."""
        added = {id(each.operand) for root in self._plans for each in nodes_in(nodes.BeliefChange, root)}
        facts = {id(each) for program in self.programs.values() for each in program.beliefs}
        return Counter(each.functor for each in self.literals if id(each) not in added | facts)

    @property
    def _plans(self) -> list[tuple[nodes.Plan, ...]]:
        return [program.plans for program in self.programs.values()]

    @cached_property
    def atoms(self) -> Counter[str]:
        """How often atoms are in the programs and the other files."""
        words = Counter(each.functor for each in self.literals if not each.arguments)
        for name, text in self.files.items():
            if not name.endswith(".asl"):
                words.update(re.findall(r"\w+", text))
        return words

    @cached_property
    def signatures(self) -> set[tuple[str, int]]:
        """Names with their numbers of arguments."""
        return {(each.functor, len(each.arguments)) for each in self.literals}

    def lasts(self, action: Node) -> bool:
        """Return whether an action is an operation of a mapping of the project that takes a given time."""
        name = getattr(action, "functor", "")
        section = re.compile(rf"^  {name}:.*\n(?:    .*\n)*?    duration:", re.MULTILINE)
        return any(section.search(text) for file, text in self.files.items() if file.endswith(".yaml"))

    def observes(self, kind: str) -> bool:
        """Return whether the programs have a name that an artifact of this type may show; True for unknown types."""
        names = shown_by(kind, self.files)
        return not names or not names.isdisjoint({each.functor for each in self.literals})

    def kinds_of(self, variable: Node, clause: Node) -> set[str]:
        """Return the types of the artifact that a variable of a clause stands for: one made there, or looked up."""
        name = getattr(variable, "name", "")
        bound = [
            each
            for each in nodes_in(nodes.Literal, clause)
            if name in {getattr(argument, "name", None) for argument in each.arguments}
        ]
        asked = {each.functor for each in bound}
        queries = [
            plan
            for program in self.programs.values()
            for plan in program.plans
            if plan.trigger.kind == "?" and getattr(plan.trigger.literal, "functor", "") in asked
        ]
        looked_up = {each.value for each in nodes_in(nodes.String, tuple(queries))}
        made = [each for each in bound if each.functor == "makeArtifact"]
        made += [
            each
            for each in self.literals
            if each.arguments and getattr(each.arguments[0], "value", "") in looked_up
        ]
        return {kind.value for each in made for kind in each.arguments[1:2] if isinstance(kind, nodes.String)}

    @cached_property
    def observes_any(self) -> bool:
        """Return whether the programs have a name that one of the artifacts that they make may show."""
        made = {
            argument.value
            for each in self.literals
            if each.functor in ("makeArtifact", "use_artifact")
            for argument in each.arguments[1:2]
            if isinstance(argument, nodes.String)
        }
        return not made or any(map(self.observes, made))

    def edits(self, name: str) -> Iterator[Edit]:
        """Yield the mistakes in one program."""
        program = self.programs[name]
        own = [
            clause
            for clause in (*program.beliefs, *program.goals, *program.plans)
            if clause.span is not None and clause.span.file.name == name
        ]
        for clause in own:
            yield from self._in_clause(clause, clause in program.goals)

    def _in_clause(self, clause: Node, is_goal: bool) -> Iterator[Edit]:
        seen = Clause(clause, self)
        if is_goal:
            yield from seen.dropped_bang(clause)
            yield from seen.goal(clause)
        elif isinstance(clause, nodes.Literal):
            yield from seen.belief(clause, is_added=True)
        for node in walk(clause):
            if node is not clause:
                yield from seen.of(node)


class Clause:
    """The mistakes in one clause."""

    def __init__(self, clause: Node, project: Project) -> None:
        self.clause, self.project = clause, project
        self.names = occurrences(clause)
        self.printed = {
            id(argument)
            for call in nodes_in(nodes.InternalAction, clause)
            if call.name in PRINTING or call.name == ".send"
            for argument in (call.arguments if call.name in PRINTING else call.arguments[:1])
        }
        self.passed = {
            id(part)
            for step in nodes_in(nodes.ExternalAction, clause)
            for part in walk(step.action.arguments if isinstance(step.action, nodes.Literal) else ())
        } | {
            id(part)
            for step in nodes_in(nodes.Achieve, clause)
            if isinstance(step.goal, nodes.Literal) and step.goal.functor == "use_artifact"
            for part in walk(step.goal.arguments)
        }
        self.annotations = {
            id(item) for marks in nodes_in(nodes.Annotations, clause) for item in marks.items
        } | {
            id(part)
            for marks in nodes_in(nodes.Annotations, clause)
            for item in marks.items
            for part in walk(item)
        }
        self.roles = dict(self._roles())

    def _roles(self) -> Iterator[tuple[int, str]]:
        """Yield what literals are: goals, actions, or beliefs that are added or asked for."""
        for node in walk(self.clause):
            if isinstance(node, nodes.Achieve):
                yield id(node.goal), "goal"
            elif isinstance(node, nodes.ExternalAction):
                yield id(node.action), "action"
            elif isinstance(node, nodes.Trigger):
                yield id(node.literal), "goal" if node.kind == "!" else "asked"
            elif isinstance(node, nodes.BeliefChange):
                yield id(node.operand), "added" if "+" in node.operator else "asked"
            elif isinstance(node, nodes.Test):
                yield from ((id(part), "asked") for part in parts_of(node.formula))
            elif isinstance(node, nodes.Plan):
                conditions = () if node.context is None else parts_of(node.context)
                yield from ((id(part), "asked") for part in conditions)
                yield id(node.label), "label"
            elif isinstance(node, nodes.Rule):
                yield from ((id(part), "asked") for part in parts_of(node.body))
            elif isinstance(node, (nodes.If, nodes.For, nodes.While)):
                yield from ((id(part), "asked") for part in parts_of(node.condition))

    def of(self, node: Node) -> Iterator[Edit]:
        """Yield the mistakes at one node."""
        if isinstance(node, nodes.Variable):
            yield from self.variable(node)
        elif isinstance(node, nodes.Achieve):
            if not node.separate and isinstance(node.goal, nodes.Literal):
                yield from self.dropped_bang(node)
            yield from self.focus_of_library(node)
        elif isinstance(node, nodes.Constraint):
            yield from self.wait(node)
        elif isinstance(node, nodes.ExternalAction):
            yield from self.focus(node)
        elif isinstance(node, nodes.Annotations):
            yield from (edit for item in node.items for edit in self.annotation(item))
        elif isinstance(node, nodes.Relation):
            yield from self.percent(node)
        elif isinstance(node, nodes.Literal):
            role = self.roles.get(id(node))
            if role == "goal":
                yield from self.goal(node)
            elif role == "action":
                yield from self.action(node)
            elif role in ("added", "asked"):
                yield from self.belief(node, role == "added")
            elif role is None and id(node) not in self.annotations:
                yield from self.atom(node)

    # Names and numbers of arguments.

    def _renamed(self, kind: str, literal: nodes.Literal, equal: str = "") -> Iterator[Edit]:
        if literal.functor in ("true", "false") or literal.functor.startswith("'"):
            return
        yield from self._at(kind, literal, literal.functor, slip(literal.functor), equal)

    def _at(self, kind: str, node: Node, old: str, new: str, equal: str = "") -> Iterator[Edit]:
        """Replace the first *old* in the text of a node, if it begins on that line."""
        span = node.span
        if span is None or old == new:
            return
        line = span.file.lines[span.line - 1]
        end = span.end_column - 1 if span.end_line == span.line else len(line)
        found = re.compile(rf"(?<![\w.]){re.escape(old)}(?!\w)").search(line, span.column - 1, end)
        if found:
            yield Edit(kind, span.line, found.start(), found.end(), new, equal)

    def _arity(self, literal: nodes.Literal, equal: str = "") -> Iterator[Edit]:
        """Drop the last argument, or add one where it is missing, or where the line is even."""
        span = literal.span
        if span is None or span.line != span.end_line or literal.functor in ("true", "false"):
            return
        arguments = literal.arguments
        start = span.column - 1 + (span.file.lines[span.line - 1][span.column - 1] == "~")
        name_end = start + len(literal.functor)
        if not arguments:
            yield Edit("arity", span.line, name_end, name_end, "(_)", equal or self._both(literal, 1))
            return
        last = arguments[-1].span
        if last is None or last.line != span.line:
            return
        if span.line % 2 == 0:
            at = last.end_column - 1
            yield Edit("arity", span.line, at, at, ", _", equal or self._both(literal, len(arguments) + 1))
            return
        before = arguments[-2].span if len(arguments) > 1 else None
        from_ = name_end if before is None else before.end_column - 1
        to = last.end_column if before is None else last.end_column - 1
        yield Edit("arity", span.line, from_, to, "", equal or self._both(literal, len(arguments) - 1))

    def _both(self, literal: nodes.Literal, count: int) -> str:
        return "both" if (literal.functor, count) in self.project.signatures else ""

    def belief(self, literal: nodes.Literal, is_added: bool) -> Iterator[Edit]:
        """Misspell a belief, or change its number of arguments."""
        equal = "unread" if is_added and not self.project.read[literal.functor] else ""
        yield from self._renamed("rename-belief", literal, equal)
        yield from self._arity(literal, equal)

    def goal(self, goal: Node) -> Iterator[Edit]:
        """Misspell a goal, or change its number of arguments."""
        if isinstance(goal, nodes.Literal):
            yield from self._renamed("rename-goal", goal)
            yield from self._arity(goal)

    def action(self, action: nodes.Literal) -> Iterator[Edit]:
        """Misspell an operation, or change its number of arguments."""
        yield from self._renamed("rename-operation", action)
        yield from self._arity(action)

    # Variables, atoms and strings.

    def variable(self, variable: nodes.Variable) -> Iterator[Edit]:
        """Misspell a variable that is there more than once, or begin it in lower case."""
        if variable.unnamed or self.names.get(variable.name, 0) < 2:
            return
        yield from self._at("rename-variable", variable, variable.name, slip(variable.name))
        yield from self._at("case-variable", variable, variable.name, _other_case(variable.name))

    def atom(self, atom: nodes.Literal) -> Iterator[Edit]:
        """Begin an atom in upper case, or write it as a string."""
        name = atom.functor
        if atom.arguments or not name.isidentifier() or name in ("true", "false") or atom.annotations:
            return
        is_unmatched = id(atom) in self.printed or id(atom) in self.passed or self.project.atoms[name] < 2
        yield from self._at("case-atom", atom, name, _other_case(name))
        yield from self._at("quote", atom, name, f'"{name}"', "unmatched" if is_unmatched else "")

    # What is left out.

    def dropped_bang(self, node: Node) -> Iterator[Edit]:
        """Post a goal without its ``!``."""
        span = node.span
        assert span is not None
        line = span.file.lines[span.line - 1]
        at = line.rfind("!", 0, span.column) if isinstance(node, nodes.Literal) else span.column - 1
        if at >= 0 and line[at] == "!":
            yield Edit("drop-bang", span.line, at, at + 1, "")

    def wait(self, step: nodes.Constraint) -> Iterator[Edit]:
        """Leave out a step that waits."""
        call, span = step.formula, step.span
        if not isinstance(call, nodes.InternalAction) or call.name != ".wait" or span is None:
            return
        line = span.file.lines[span.line - 1]
        end = span.end_column - 1
        if span.line == span.end_line and line[end : end + 1] == ";":
            yield Edit("drop-wait", span.line, span.column - 1, end + 1, "", self._pace(call, step))

    def _pace(self, call: nodes.InternalAction, step: nodes.Constraint) -> str:
        plan = self.clause
        if not isinstance(plan, nodes.Plan) or not isinstance(plan.body, nodes.Body):
            return "pace"
        later = [each for each in plan.body.steps if each.span and step.span and each.span > step.span]
        if isinstance(call.arguments[0], nodes.Number):
            goals = {each.goal for each in nodes_in(nodes.Achieve, tuple(later))}
            acts = any(True for _ in nodes_in(nodes.ExternalAction, plan.body))
            names = {each.functor for each in goals if isinstance(each, nodes.Literal)}
            head = plan.trigger.literal
            is_loop = isinstance(head, nodes.Literal) and head.functor in names and not acts
            is_endless = isinstance(head, nodes.Literal) and not self._counts_to_an_end(head, goals)
            return "" if is_loop and is_endless else "pace"
        awaited = {each.functor for each in nodes_in(nodes.Literal, call.arguments[0])}
        for after in later:
            if any(
                each.functor in awaited and self.roles.get(id(each)) == "asked"
                for each in nodes_in(nodes.Literal, after)
            ):
                return ""
            if isinstance(after, nodes.ExternalAction) and self.project.lasts(after.action):
                return "pace"
        return "pace"

    def _counts_to_an_end(self, head: nodes.Literal, goals: Iterable[Node]) -> bool:
        """Return whether a goal is posted again with another number, and a plan for one number does not post it."""
        own = [each for each in goals if isinstance(each, nodes.Literal) and each.functor == head.functor]
        counts = any(isinstance(part, nodes.Arithmetic) for each in own for part in each.arguments)
        ends = [
            plan
            for program in self.project.programs.values()
            for plan in program.plans
            if (plan.trigger.operator, plan.trigger.kind) == ("+", "!")
            and getattr(plan.trigger.literal, "functor", "") == head.functor
            and any(isinstance(each, nodes.Number) for each in getattr(plan.trigger.literal, "arguments", ()))
            and not any(True for _ in nodes_in(nodes.Achieve, plan.body))
        ]
        return counts and bool(ends)

    def focus(self, step: nodes.ExternalAction) -> Iterator[Edit]:
        """Leave out a step that focuses."""
        span = step.span
        action = step.action
        if isinstance(action, nodes.Literal) and action.functor.startswith("focus") and span is not None:
            line = span.file.lines[span.line - 1]
            end = span.end_column - 1
            if span.line == span.end_line and line[end : end + 1] == ";":
                kinds = self.project.kinds_of(action.arguments[0], self.clause) if action.arguments else set()
                observes = any(map(self.project.observes, kinds)) if kinds else self.project.observes_any
                equal = "" if observes else "unobserved"
                yield Edit("drop-focus", span.line, span.column - 1, end + 1, "", equal)

    def focus_of_library(self, step: nodes.Achieve) -> Iterator[Edit]:
        """Make an artifact as the library does, but do not focus it."""
        goal = step.goal
        if not isinstance(goal, nodes.Literal) or goal.functor != "use_artifact" or goal.span is None:
            return
        line = goal.span.file.lines[goal.span.line - 1]
        if goal.span.line != goal.span.end_line:
            return
        text = line[goal.span.column - 1 : goal.span.end_column - 1]
        inner = text[text.index("(") + 1 : -1] + (", []" if len(goal.arguments) == 2 else "")
        equal = "" if self.project.observes(str(getattr(goal.arguments[1], "value", ""))) else "unobserved"
        at = goal.span.column - 1
        yield Edit(
            "drop-focus",
            goal.span.line,
            at - 1,
            goal.span.end_column - 1,
            f"makeArtifact({inner}, _)",
            equal,
        )

    # Annotations and units.

    def annotation(self, item: Node) -> Iterator[Edit]:
        """Write another word for an annotation."""
        if isinstance(item, nodes.Literal) and item.functor in SWAPPED:
            yield from self._at("annotation", item, item.functor, SWAPPED[item.functor])

    def percent(self, relation: nodes.Relation) -> Iterator[Edit]:
        """Compare the percentage of a battery with a fraction."""
        right = relation.right
        if not isinstance(right, nodes.Number) or not isinstance(relation.left, nodes.Variable):
            return
        levels = [each for each in nodes_in(nodes.Literal, self.clause) if each.functor == "battery"]
        if any(each.arguments and each.arguments[0] == relation.left for each in levels):
            yield from self._at("unit", right, f"{right.value:g}", f"{right.value / 100:g}")


def dropped_focus(lines: list[str], project: Project) -> Iterator[Edit]:
    """Leave out a focus of a project file."""
    for number, line in enumerate(lines, 1):
        for found in re.finditer(r"(?<!\w)focus(?:ed-by)?: *([\w.]+(?:, *[\w.]+)*)", line):
            name = re.split(r"[ ,]+", found[1])[0]
            artifact = line.split()[1].rstrip(":") if "focused-by" in found[0] else name.rpartition(".")[2]
            declared = re.search(rf"artifact +{artifact} *: *\"?([\w.]+)", "\n".join(lines))
            mapping = f"{artifact}.yaml" if f'"{artifact}.yaml"' in "\n".join(lines) else ""
            kind = declared[1] if declared else mapping
            joins = _joins_by(found[0], number, lines)
            equal = "" if joins or project.observes(kind) else "unobserved"
            yield Edit("drop-focus", number, found.start(), found.end(), "", equal)


def _joins_by(focus: str, number: int, lines: list[str]) -> bool:
    """Return whether an agent joins a workspace only by this focus, as far as the project file shows."""
    names = re.findall(r"[\w.]+", focus.partition(":")[2])
    if "focused-by" not in focus:
        return any("." in name and not name.startswith("main.") for name in names)
    start = max(at for at in range(number) if "workspace" in lines[at])
    end = next(at for at in range(number, len(lines)) if lines[at].strip() == "}")
    others = "\n".join(lines[start : number - 1] + lines[number:end])
    focusing = set(re.findall(r"\w+", " ".join(re.findall(r"focused-by: *([\w, ]+)", others))))
    return lines[start].split()[1] != "main" and not focusing.issuperset(names)


def units(lines: list[str], project: Project) -> Iterator[Edit]:
    """Leave out a unit of a mapping."""
    used = {each.functor for each in project.literals}
    part = ""  # the property, signal or operation that the line belongs to
    for number, line in enumerate(lines, 1):
        head = re.match(r"  (\w+):", line)
        part = head[1] if head else part
        for found in re.finditer(r"(, *)unit: *(degrees|percent)", line):
            yield Edit("unit", number, found.start(), found.end(), "", "" if part in used else "unread")
