#!/usr/bin/env bash
# Installs what is needed, builds everything and runs all tests.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
"$root/tools/setup.sh"
"$root/tools/build.sh" all
ctest --test-dir "$root/build" --output-on-failure "$@"
