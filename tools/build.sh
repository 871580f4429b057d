#!/usr/bin/env bash
# Builds build/outrider in Release. Extra arguments are ninja targets (default: outrider).
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
[ -f "$root/build/build.ninja" ] || cmake -S "$root" -B "$root/build" -G Ninja >/dev/null
cmake --build "$root/build" --target "${@:-outrider}"
