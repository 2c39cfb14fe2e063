#!/bin/sh
# Print the first interpreter here that is Python 3.11 or newer and can create a venv; nothing without one.
for python in python3 python3.11 python3.12 python3.13 python3.14; do
  if "$python" -c 'import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then
    echo "$python"
    exit 0
  fi
done
