#!/usr/bin/env bash
# Install a program that only tests need: install_program.sh PACKAGE NAME...  Any of the names will do; a file has its full path.
# Exit code 3: this system cannot have it.
set -euo pipefail

package=$1
shift
say() { echo "install_program: $*" >&2; }
refuse() { say "CANNOT INSTALL ${package^^} HERE: $*"; exit 3; }

PATH=$PATH:/usr/sbin
for name in "$@"; do
  if command -v "$name" >/dev/null || [[ $name = /* && -e $name ]]; then say "$name: there"; exit 0; fi
done
command -v apt-get >/dev/null || refuse "this is not a Debian system; install $package by hand"
as_root=()
if [ "$(id -u)" != 0 ]; then
  command -v sudo >/dev/null || refuse "not root, and there is no sudo"
  as_root=(sudo -n)
fi
"${as_root[@]}" apt-get update -q >&2 || refuse "apt-get update failed"
# At run level 1 Debian starts no service of the package.
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive RUNLEVEL=1 apt-get install -q -y --no-install-recommends "$package" >&2
say "$package: installed"
