#!/bin/sh
# From recorded drives to a map, in one command: setup/run.sh [DRIVE...]
#
# Installs what is missing, builds, then maps the drives as sessions of one place (default: a small
# simulated car park), makes the overhead image, the road network, the speeds, an OpenDRIVE file
# and a report, and lists what became of each step. A step that has nothing to show says so and does
# not stop the others; a step that needs the result of a failed one is skipped. A step whose result
# is newer than what it is made from is not done again.
#
# Results go to out/NAME, NAME being the drives' folder names joined by "+". Exit status: 0 if every
# step went through, else that of the first step that did not (4: it has nothing to show).
# With ROADBOOK=PROGRAM in the environment, nothing is installed or built, and PROGRAM is run.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
export LC_ALL=C.UTF-8

name=
drives=  # one path a line
for given in "$@"; do
  [ -d "$given" ] || { echo "error: $given: got no such folder, want a recorded drive" >&2; exit 2; }
  drive=$(cd "$given" && pwd)
  name=$name${name:++}$(basename "$drive")
  drives="$drives$drive
"
done
name=${name:-zurich_small}

if [ -n "${ROADBOOK:-}" ]; then
  roadbook=$ROADBOOK
else
  cd "$root"
  setup/install.sh
  setup/build.sh roadbook
  roadbook=$root/build/release/apps/roadbook
fi
out=${ROADBOOK_OUT:-$root/out}/$name
mkdir -p "$out"

simulated=
if [ -z "$drives" ]; then
  simulated=$out/drive
  drives="$simulated
"
fi
# Marks of other drives of the same names say nothing of these.
if [ "$(cat "$out/.drives" 2>/dev/null)" != "$(printf '%s' "$drives")" ]; then
  rm -f "$out"/.*.done
  printf '%s' "$drives" > "$out/.drives"
fi

states=       # a line for each step: NAME, state
bad=          # " NAME" for each step without a result
exit_status=0

# is_newer PATH MARK: whether the file, or a table, calibration or mask in the folder, changed after
# MARK.
is_newer() {
  if [ -d "$1" ]; then
    [ -n "$(find "$1" -maxdepth 3 \( -name '*.yaml' -o -name '*.csv' -o -name mask.png -o -type d -name 'cam*' \) -newer "$2" | head -n 1)" ]
  else
    [ "$1" -nt "$2" ]
  fi
}

note() {
  states="$states$(printf '%-10s %s' "$1" "$2")
"
}

# step NAME NEEDS COMMAND...: runs the command unless a step named in NEEDS (separated by commas;
# "name+" is used where it is there, but not needed) is without result, or NAME's mark is newer than
# the marks of NEEDS, than the inputs and than the program.
step() {
  step_name=$1
  needs=$(echo "$2" | tr ',' ' ')
  shift 2
  mark=$out/.$step_name.done
  stale=
  [ -e "$mark" ] && [ ! "$roadbook" -nt "$mark" ] || stale=1
  for need in $needs; do
    before=${need%+}
    case "$bad " in
    *" $before "*)
      if [ "$before" = "$need" ]; then
        note "$step_name" "skipped: needs the result of $before"
        echo "$step_name: skipped, it needs the result of $before"
        bad="$bad $step_name"
        rm -f "$mark"
        return 0
      fi
      ;;
    esac
    [ -n "$stale" ] || ! is_newer "$out/.$before.done" "$mark" || stale=1
  done
  if [ "$step_name" = map ]; then
    while read -r input; do
      [ -n "$stale" ] || ! is_newer "$input" "$mark" || stale=1
    done <<END
$drives
END
  fi
  if [ -z "$stale" ]; then
    echo "$step_name: up to date"
    note "$step_name" "up to date"
    return 0
  fi
  [ "$1" != "$roadbook" ] || echo "$step_name: $*"
  rm -f "$mark"
  status=0
  "$@" || status=$?
  case $status in
  0)
    note "$step_name" "done"
    touch "$mark"
    return 0
    ;;
  4) note "$step_name" "nothing to show (exit status 4; the message is above)" ;;
  5 | 130 | 143)
    echo "error: $step_name: interrupted; the same command goes on from there" >&2
    exit 5
    ;;
  *) note "$step_name" "failed (exit status $status; the message is above)" ;;
  esac
  bad="$bad $step_name"
  [ "$exit_status" -ne 0 ] || exit_status=$status
}

simulate() {
  rm -rf "$simulated"
  echo "simulate: $roadbook simulate zurich --size small -o $simulated"
  "$roadbook" simulate zurich --size small -o "$simulated"
}

# The drives are read from their list, so that names with blanks stay whole.
build_map() {
  set --
  while read -r input; do
    [ -z "$input" ] || set -- "$@" "$input"
  done <<END
$drives
END
  echo "map: $roadbook map $* -m $map --replace"
  "$roadbook" map "$@" -m "$map" --replace
}

map=$out/$name.gpkg
first=
if [ -n "$simulated" ]; then
  step simulate "" simulate
  first=simulate
fi
step map "$first" build_map
step overhead map "$roadbook" overhead -m "$map"
step roads map "$roadbook" roads -m "$map"
step speeds roads "$roadbook" speeds -m "$map"
step opendrive "roads,speeds+" "$roadbook" export -m "$map" --format opendrive -o "$out/$name.xodr"
step report "map,overhead+,roads+,speeds+" "$roadbook" report -m "$map" -o "$out/report.html"

echo
printf '%s' "$states"
echo
printf '%s' "$drives" | sed 's/^/drive    /'
[ ! -e "$map" ] || echo "map      $map   (a GeoPackage: opens in QGIS)"
[ ! -e "$out/report.html" ] || echo "report   $out/report.html"
exit "$exit_status"
