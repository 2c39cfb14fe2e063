"""Findings as JSON and as SARIF 2.1.0 (https://docs.oasis-open.org/sarif/sarif/v2.1.0/)."""

import json
from pathlib import Path
from typing import Any
from urllib.parse import quote

from jacaros.agents.language.diagnostics import LEVELS, Diagnostic, Span
from jacaros.cli.version import version_of
from jacaros.files.texts import printable
from jacaros.mas.checks.files import Findings

Object = dict[str, Any]
SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"


def as_json(findings: Findings) -> str:
    """Return the findings as one JSON object; lines and columns count from 1, and the end column is exclusive."""
    return json.dumps(
        {
            "version": 1,
            "files": len(findings.files),
            "diagnostics": [_plain(diagnostic) for diagnostic in findings.diagnostics],
        },
        indent=2,
        ensure_ascii=False,
    )


def _plain(diagnostic: Diagnostic) -> Object:
    span = diagnostic.span
    return {
        "file": None if span is None else span.file.name,
        "line": None if span is None else span.line,
        "column": None if span is None else span.column,
        "end_line": None if span is None else span.end_line,
        "end_column": None if span is None else span.end_column,
        "level": diagnostic.severity,
        "code": diagnostic.code,
        "message": printable(diagnostic.message),
        "help": None if diagnostic.help is None else printable(diagnostic.help),
        "opened": None if diagnostic.opened is None else [diagnostic.opened.line, diagnostic.opened.column],
    }


def as_sarif(findings: Findings) -> str:
    """Return the findings as a SARIF log with one run."""
    codes = sorted({diagnostic.code for diagnostic in findings.diagnostics})
    driver = {
        "name": "jacaros",
        "version": version_of("jacaros"),
        "rules": [_rule(code) for code in codes],
    }
    results = [_result(diagnostic, codes) for diagnostic in findings.diagnostics]
    run = {"tool": {"driver": driver}, "columnKind": "unicodeCodePoints", "results": results}
    return json.dumps({"$schema": SCHEMA, "version": "2.1.0", "runs": [run]}, indent=2, ensure_ascii=False)


def _rule(code: str) -> Object:
    return {
        "id": code,
        "shortDescription": {"text": code.replace("-", " ")},
        "defaultConfiguration": {"level": LEVELS[code]},
    }


def _result(diagnostic: Diagnostic, codes: list[str]) -> Object:
    text = diagnostic.message if diagnostic.help is None else f"{diagnostic.message}. {diagnostic.help}"
    text = printable(text)
    result: Object = {
        "ruleId": diagnostic.code,
        "ruleIndex": codes.index(diagnostic.code),
        "level": diagnostic.severity,
        "message": {"text": text},
    }
    if diagnostic.span is not None:
        result["locations"] = [_location(diagnostic.span)]
    if diagnostic.opened is not None:
        result["relatedLocations"] = [{**_location(diagnostic.opened), "message": {"text": "opened here"}}]
    return result


def _location(span: Span) -> Object:
    region = {
        "startLine": span.line,
        "startColumn": span.column,
        "endLine": span.end_line,
        "endColumn": span.end_column,
    }
    return {"physicalLocation": {"artifactLocation": {"uri": _uri(span.file.name)}, "region": region}}


def _uri(name: str) -> str:
    path = Path(name)
    return path.as_uri() if path.is_absolute() else quote(path.as_posix())
