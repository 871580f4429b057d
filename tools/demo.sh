#!/usr/bin/env bash
# Installs what is needed, builds, maps a real log, explores an office with four robots, and says where the reports are.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
"$root/tools/setup.sh"
"$root/tools/build.sh"
outrider="$root/build/outrider"
runs="$root/runs"
log="/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog"

echo "== A real log becomes a map: one loop through the Telecom faculty of Malaga (MRPT's packaged rawlog)"
"$outrider" replay "$log" --slam icp --out "$runs/demo-replay" --force
echo
echo "== Four unlike robots explore an office that they do not know (DAA-A auctions)"
"$outrider" explore office --robots 4 --coordinator daa --out "$runs/demo-explore" --force
echo
echo "Reports: $runs/demo-replay/report.html"
echo "         $runs/demo-explore/report.html"
