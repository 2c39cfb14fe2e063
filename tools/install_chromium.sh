#!/usr/bin/env bash
# Install a headless browser for the tests of the replay page. Exit code 3: this system cannot have it.
set -euo pipefail

say() { echo "install_chromium: $*" >&2; }
refuse() { say "CANNOT INSTALL CHROMIUM HERE: $*"; exit 3; }

for name in chromium chromium-browser google-chrome; do
  if command -v "$name" >/dev/null; then say "$name: there"; exit 0; fi
done
command -v apt-get >/dev/null || refuse "this is no Debian system; install Chromium by hand"
as_root=()
if [ "$(id -u)" != 0 ]; then
  command -v sudo >/dev/null || refuse "not root, and there is no sudo"
  as_root=(sudo -n)
fi
"${as_root[@]}" apt-get update -q >&2 || refuse "apt-get update failed"
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends chromium >&2
say "chromium: installed"
