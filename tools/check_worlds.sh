#!/usr/bin/env bash
# Every coordinator in every embedded world and on the maps given: each run must end with a verdict, and with the same
# bytes the second time. Prints a line a run; exit code 1 when any run timed out, failed or differed.
#   tools/check_worlds.sh [-c "daa nearest"] [-s "disc lidar"] [-1] [MAP[@RESOLUTION]...]      -1: no second run
set -euo pipefail
outrider=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)/build/outrider
coordinators=$("$outrider" list coordinators | awk '{print $1}')
sensings="disc lidar" twice=1
while getopts c:s:1 option; do
  case $option in
    c) coordinators=$OPTARG ;;
    s) sensings=$OPTARG ;;
    1) twice=0 ;;
    *) exit 2 ;;
  esac
done
shift $((OPTIND - 1))
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
bad=0
for world in $("$outrider" list worlds | awk '{print $1}') "$@"; do
  where=("${world%@*}")
  [[ $world == *@* ]] && where+=(--resolution "${world#*@}")
  for sensing in $sensings; do
    for coordinator in $coordinators; do
      run=("$outrider" explore "${where[@]}" --robots 4 --coordinator "$coordinator" --sensing "$sensing" -q --out)
      code=0
      rm -rf "$folder/a" "$folder/b"
      "${run[@]}" "$folder/a" || code=$?
      verdict=$(grep -o '"status": "[a-z_]*"' "$folder/a/run.json" 2>/dev/null | head -1 | cut -d'"' -f4) || verdict=none
      note=
      if ((twice)); then
        "${run[@]}" "$folder/b" || true
        for side in a b; do sed -i '/"timing"/,$d; s#'"$folder/$side"'#RUN#' "$folder/$side/run.json"; done
        diff -rq -x report.html "$folder/a" "$folder/b" >/dev/null || note=" DIFFERS"
      fi
      [[ $verdict == explored || $verdict == unreachable_left ]] && ((code <= 1)) && [[ -z $note ]] || bad=1
      printf '%-28s %-6s %-18s %s (%d)%s\n' "$(basename "$world")" "$sensing" "$coordinator" "$verdict" "$code" "$note"
    done
  done
done
exit $bad
