"""Errors as problem documents (RFC 9457)."""

import json
from collections.abc import Mapping, Sequence
from http import HTTPStatus
from typing import Any

from starlette.responses import Response

from jacaros.serving.arguments import reasons_of
from jacaros.serving.callers import RequestError

MEDIA_TYPE = "application/problem+json"
STATUS = {
    "malformed": 400,
    "unauthorized": 401,
    "not_permitted": 403,
    "foreign_host": 403,
    "foreign_origin": 403,
    "unknown_path": 404,
    "unknown_agent": 404,
    "unknown_goal": 404,
    "unknown_question": 404,
    "not_offered": 404,
    "method_not_allowed": 405,
    "refused": 409,
    "too_large": 413,
    "invalid_arguments": 422,
    "unanswerable": 422,
    "too_many_requests": 429,
    "internal_error": 500,
    "ended": 503,
    "unresponsive": 503,
}
"""Status of the response for each ``code`` of a problem."""
_HEADERS: Mapping[str, Mapping[str, str]] = {
    "unauthorized": {"WWW-Authenticate": "Bearer"},
    "too_many_requests": {"Retry-After": "1"},
}
HEADERS = {"Cache-Control": "no-store", "X-Content-Type-Options": "nosniff"}
"""Headers of every response."""


def problem(code: str, detail: str, reasons: Sequence[str] = (), **more: Any) -> Response:
    """Return a problem document as a response."""
    status = STATUS.get(code, 400)
    document = {
        "type": "about:blank",
        "title": HTTPStatus(status).phrase,
        "status": status,
        "detail": detail,
        "code": code,
        "reasons": list(reasons),
        **more,
    }
    return Response(f"{json.dumps(document)}\n", status, {**HEADERS, **_HEADERS.get(code, {})}, MEDIA_TYPE)


def of_error(error: RequestError) -> Response:
    """Return the problem document of a request that has no effect."""
    return problem(error.code, error.message, reasons_of(error.reasons))
