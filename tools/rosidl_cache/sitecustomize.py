"""Have the ROS 2 interface generators do the same work once only, while our interfaces are built.

`tools/build_ros2_interfaces.sh` puts this folder on PYTHONPATH for the build.  Nothing installed is changed.  Each of the
six generators parses each definition anew, and expands the same templates for every type, with a scanner that looks at
every character in Python: together that is most of the build's time.  What is kept here depends on the text alone.

ROSIDL_CACHE names the folder for parsed definitions.
"""

import os
import sys


def _keep_tokens() -> None:
    """Remember what templates are made of: the same text gives the same token, and running a token does not change it."""
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
    """Remember what parsed definitions say, for the next generator."""
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
        os.replace(part, path)  # generators run side by side
        return content

    parser.parse_idl_string = remembered


_program = " ".join(sys.orig_argv)
if "rosidl_" in _program and "ROSIDL_CACHE" in os.environ:
    _keep_tokens()
    _keep_definitions(os.environ["ROSIDL_CACHE"])
