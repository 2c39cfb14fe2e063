"""Make the ROS 2 interface generators do repeated work only once while our interfaces are built.

`tools/build_ros2_interfaces.sh` puts this folder on PYTHONPATH for the build; no installed file is changed. Each of the six
generators parses each definition again, and expands the same templates for every type, with a scanner in Python that
inspects every character: together this is most of the build time. The cached data depends on the text alone.

ROSIDL_CACHE names the folder for parsed definitions.
"""

import os
import sys


def _keep_tokens() -> None:
    """Cache the tokens of templates: the same text gives the same token, and running a token does not change it."""
    import em  # type: ignore[import-not-found]

    scan = em.Scanner.one
    tokens: dict[tuple[str, str], tuple[object, int]] = {}

    def remembered(self: em.Scanner) -> object:
        key = (self.prefix, self.buffer[self.pointer :])
        if key not in tokens:
            before = len(self)
            token = scan(self)
            tokens[key] = token, before - len(self)
            return token
        token, length = tokens[key]
        self.advance(length)
        self.sync()
        return token

    em.Scanner.one = remembered


def _keep_definitions(folder: str) -> None:
    """Cache parsed definitions for the next generator."""
    import hashlib
    import pickle

    from rosidl_parser import parser  # type: ignore[import-not-found]

    parse = parser.parse_idl_string

    def remembered(text: str, png_file: str | None = None) -> object:
        path = os.path.join(folder, hashlib.sha256(text.encode()).hexdigest())
        if os.path.exists(path):
            with open(path, "rb") as file:
                return pickle.load(file)
        content = parse(text, png_file=png_file)
        part = f"{path}.{os.getpid()}"
        with open(part, "wb") as file:
            pickle.dump(content, file)
        os.replace(part, path)  # generators run in parallel
        return content

    parser.parse_idl_string = remembered


_program = " ".join(sys.orig_argv)
if "rosidl_" in _program and "ROSIDL_CACHE" in os.environ:
    _keep_tokens()
    _keep_definitions(os.environ["ROSIDL_CACHE"])
