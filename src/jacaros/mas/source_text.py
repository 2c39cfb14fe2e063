"""The text of programs and project files."""

from pathlib import Path


def source_text(path: Path) -> str:
    """The text of a file in UTF-8; the byte order mark that some editors put in front is left out.

    Raises:
        FileNotFoundError: it is not there.
        OSError: it cannot be read; the message says why in words.
        UnicodeError: it is no UTF-8; the message tells the line.
    """
    try:
        return path.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise
    except OSError as fault:
        raise OSError(fault.strerror or str(fault)) from fault
    except UnicodeDecodeError as fault:
        line = fault.object.count(b"\n", 0, fault.start) + 1
        byte = fault.object[fault.start]
        raise UnicodeError(
            f"line {line} holds a byte (0x{byte:02x}) that is no UTF-8; save the file as UTF-8"
        ) from fault
