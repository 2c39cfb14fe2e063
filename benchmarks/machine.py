"""The machine on which figures were measured."""

import os
import platform
import sysconfig
from datetime import UTC, datetime
from pathlib import Path
from statistics import median

from mind.marks import seconds_for_a_call


def machine() -> dict[str, str | int | float]:
    """Return what a reader must know about the machine."""
    return {
        "processor": _processor(),
        "cores": os.cpu_count() or 1,
        "gigabytes": round(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30),
        "system": _system(),
        "python": f"{platform.python_implementation()} {platform.python_version()} ({_build()})",
        "load": round(os.getloadavg()[0], 1),
        "call": median(seconds_for_a_call() for _ in range(5)) * 1e9,
        "date": datetime.now(UTC).strftime("%Y-%m-%d"),
    }


def _processor() -> str:
    info = Path("/proc/cpuinfo")
    if info.exists():
        for line in info.read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()


def _system() -> str:
    try:
        return f"{platform.freedesktop_os_release()['PRETTY_NAME']}, {platform.machine()}"
    except (OSError, KeyError):
        return f"{platform.system()} {platform.release()}, {platform.machine()}"


def _build() -> str:
    configured = str(sysconfig.get_config_var("CONFIG_ARGS") or "")
    return "optimised" if "--enable-optimizations" in configured else "built without optimisations"
