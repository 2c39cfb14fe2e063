#!/usr/bin/env bash
# Install what the tests of the site need: a browser, and axe-core, which npm brings. Exit code 3: this system cannot have it.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/install_program.sh chromium chromium chromium-browser google-chrome
tools/install_program.sh npm npm
npm ci --silent --prefix site
