"""``python simulated_windows.py ARGUMENT...``: the jacaros command where Python has only what it has on Windows.

It runs on Linux.  POSIX-only signals, functions and modules are gone before jacaros is imported, and what works in another
way there does so here:

* A signal does not interrupt what the main thread waits for; only the wake-up descriptor does (of asyncio's Proactor loop).
* The default loop has no signal handlers and watches no descriptors for others.
* A file that is open cannot be removed or replaced; a folder cannot be opened; names of files have no ``:`` or ``*``.
* The standard streams are cp1252 (set by the caller), and code of ours that opens a text file without an encoding fails.
* Threads have small stacks (and the main thread, set by the caller), and the steady clock has ticks of 1/64 s.

It is a lower bound: paths stay those of POSIX, and libraries that were imported before believe to be on Linux.
"""

import asyncio
import asyncio.subprocess
import importlib
import os
import select
import selectors
import signal
import socket
import stat
import sys
import sysconfig
import threading
import time
import warnings
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

LIBRARIES = (
    *("click", "click._compat", "click.testing", "concurrent.futures.thread", "multiprocessing.connection"),
    *("numpy", "platform", "rich.console", "rich.live", "rich.text", "rosbags.typesys", "ruamel.yaml"),
    *("subprocess", "tempfile", "unittest", "webbrowser", "websockets.asyncio.client"),
    *("websockets.asyncio.server",),
)
"""Imported first: they look at the platform when they are."""
SIGNAL_NAMES = (
    *("SIGABRT", "SIGFPE", "SIGILL", "SIGINT", "SIGSEGV", "SIGTERM", "SIG_DFL", "SIG_IGN", "NSIG"),
    *("Signals", "Handlers", "default_int_handler", "getsignal", "raise_signal", "set_wakeup_fd", "signal"),
    *("strsignal", "valid_signals"),
)
"""What the module `signal` has on Windows, besides ``SIGBREAK`` and two events."""
SIGBREAK = 21
POSIX_FUNCTIONS = (
    *("fork", "forkpty", "getuid", "geteuid", "getgid", "getegid", "getgroups", "getpgid", "getpgrp"),
    *("getsid", "setsid", "setuid", "setgid", "setpgid", "killpg", "mkfifo", "mknod", "uname", "statvfs"),
    *("fstatvfs", "sysconf", "getloadavg", "nice", "wait", "wait3", "wait4", "waitid", "chown", "fchown"),
    *("lchown", "fchmod", "fchdir", "chroot", "getpriority", "sched_getaffinity", "sched_setaffinity"),
    *("sched_yield", "openpty", "ttyname", "tcgetpgrp", "pread", "pwrite", "readv", "writev", "posix_spawn"),
    *("posix_spawnp", "pipe2", "O_NONBLOCK", "O_NOCTTY", "O_NOFOLLOW", "O_CLOEXEC", "O_DIRECTORY", "O_SYNC"),
    *("O_DSYNC", "O_PATH"),
)
POSIX_MODULES = ("crypt", "fcntl", "grp", "pty", "pwd", "readline", "resource", "syslog", "termios", "tty")
STACK = 512 * 1024
"""Bytes of a thread's stack: that of macOS."""
TICK = 1 / 64
"""Seconds between two values of the steady clock."""
FORBIDDEN = frozenset(':*?"<>|')
"""Characters that no name of a file has."""


class ProactorEventLoop(asyncio.SelectorEventLoop):
    """The default loop of Windows, as far as a program can tell."""

    def __init__(self) -> None:
        super().__init__()
        if threading.current_thread() is threading.main_thread():
            signal.set_wakeup_fd(self._csock.fileno())  # type: ignore[attr-defined]

    def close(self) -> None:
        if not self.is_running() and threading.current_thread() is threading.main_thread():
            signal.set_wakeup_fd(-1)
        super().close()


def refuse(self: object, *arguments: object) -> None:
    raise NotImplementedError


def receive_signals_elsewhere() -> None:
    """Have signals arrive in another thread, as on Windows: Python's handlers wait for the main thread's next step."""
    theirs = {signal.SIGINT, signal.SIGTERM, signal.Signals(SIGBREAK)}
    threading.Thread(target=threading.Event().wait, daemon=True).start()
    signal.pthread_sigmask(signal.SIG_BLOCK, theirs)


def take_posix_away() -> None:
    for name in [name for name in vars(signal) if not name.startswith("_") and name not in SIGNAL_NAMES]:
        delattr(signal, name)
    signal.SIGBREAK = SIGBREAK  # type: ignore[attr-defined]
    signal.CTRL_C_EVENT, signal.CTRL_BREAK_EVENT = 0, 1  # type: ignore[attr-defined]
    set_handler = signal.signal

    def checked(number: int, handler: Any) -> Any:
        if int(number) not in (2, 4, 6, 8, 11, 15, SIGBREAK):
            raise ValueError("invalid signal value")
        return set_handler(number, handler)

    signal.signal = checked  # type: ignore[assignment]
    for name in POSIX_FUNCTIONS:
        if hasattr(os, name):
            delattr(os, name)
    os.O_BINARY = 0  # type: ignore[attr-defined]
    for name in ("poll", "epoll"):
        delattr(select, name)
    socket.socketpair = partial(socket.socketpair, socket.AF_UNIX)  # type: ignore[assignment]
    del socket.AF_UNIX
    for module in POSIX_MODULES:
        sys.modules[module] = None  # type: ignore[assignment]
    selectors.DefaultSelector = selectors.SelectSelector  # type: ignore[misc]


def change_loops() -> None:
    for name in ("add_signal_handler", "remove_signal_handler"):
        setattr(asyncio.SelectorEventLoop, name, refuse)
    for name in ("add_reader", "remove_reader", "add_writer", "remove_writer"):
        setattr(ProactorEventLoop, name, refuse)
    for name in ("create_unix_server", "create_unix_connection"):
        setattr(asyncio.SelectorEventLoop, name, refuse)
    for name in ("open_unix_connection", "start_unix_server"):
        delattr(asyncio, name)
    asyncio.ProactorEventLoop = ProactorEventLoop  # type: ignore[attr-defined]


def protect_open_files() -> None:
    """Refuse to remove or replace a file that this process has open, to open a folder, and names that Windows has not."""

    def guarded(function: Any) -> Any:
        def call(*paths: Any, **options: Any) -> Any:
            for path in paths:
                if isinstance(path, (str, os.PathLike)) and _is_open(os.fspath(path)):
                    raise PermissionError(13, "The process cannot access the file: it is in use", str(path))
            return function(*paths, **options)

        return call

    for name in ("replace", "rename", "remove", "unlink"):
        setattr(os, name, guarded(getattr(os, name)))
    open_file = os.open

    def open_no_folder(path: Any, *arguments: Any, **options: Any) -> int:
        number = open_file(path, *arguments, **options)
        if stat.S_ISDIR(os.fstat(number).st_mode):
            os.close(number)
            raise PermissionError(13, "Permission denied", str(path))
        return number

    os.open = open_no_folder
    sys.addaudithook(_check_name)


def _is_open(path: str) -> bool:
    with suppress(OSError):
        wanted = os.stat(path)
        for number in os.listdir("/proc/self/fd"):
            with suppress(OSError):
                if os.path.samestat(os.fstat(int(number)), wanted):
                    return True
    return False


def _check_name(event: str, arguments: tuple[Any, ...]) -> None:
    if event in ("open", "os.mkdir") and isinstance(arguments[0], (str, os.PathLike)):
        path = os.fspath(arguments[0])
        if isinstance(path, str) and not FORBIDDEN.isdisjoint(path) and not path.startswith("<"):
            raise OSError(22, "Invalid argument", path)


def slow_clock() -> None:
    exact = time.monotonic
    time.monotonic = lambda: exact() // TICK * TICK  # type: ignore[assignment]


def become_windows() -> None:
    for library in LIBRARIES:
        importlib.import_module(library)
    sysconfig.get_config_vars()
    receive_signals_elsewhere()
    take_posix_away()
    change_loops()
    protect_open_files()
    slow_clock()
    threading.stack_size(STACK)
    warnings.filterwarnings("error", category=EncodingWarning, module=r"jacaros\b")
    sys.platform = "win32"


if __name__ == "__main__":
    become_windows()
    sys.path[0] = str(Path.cwd())
    from jacaros.runtime.cli.main import main

    main(sys.argv[1:])
