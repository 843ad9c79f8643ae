#!/bin/sh
# From a drive to a map, in one command: setup/run.sh [DRIVE]
#
# Installs what is missing, builds, then maps DRIVE (default: a small simulated car park), makes the
# overhead image, the road network and a report, and prints where the files are. Steps whose results
# are newer than what they are made from are not done again.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
drive=
if [ $# -gt 1 ]; then
  echo "usage: setup/run.sh [DRIVE]" >&2
  exit 1
elif [ $# -eq 1 ]; then
  [ -d "$1" ] || { echo "error: $1: got no such folder, want a recorded drive" >&2; exit 2; }
  drive=$(cd "$1" && pwd)
fi
cd "$root"
export LC_ALL=C.UTF-8
setup/install.sh
setup/build.sh roadbook
roadbook=build/release/apps/roadbook

if [ -n "$drive" ]; then
  name=$(basename "$drive")
else
  name=zurich_small
fi
out=out/$name
mkdir -p "$out"

# step NAME INPUT COMMAND...: runs the command unless its mark is newer than INPUT and the program.
step() {
  step_name=$1
  input=$2
  shift 2
  mark=$out/.$step_name.done
  if [ -e "$mark" ] && [ ! "$roadbook" -nt "$mark" ] && [ ! "$input" -nt "$mark" ]; then
    echo "$step_name: up to date"
    return
  fi
  echo "$step_name: $*"
  "$@"
  touch "$mark"
}

if [ -z "$drive" ]; then
  drive=$out/drive
  simulate() {
    rm -rf "$drive"
    "$roadbook" simulate zurich --size small -o "$drive"
  }
  step simulate "$roadbook" simulate
  input=$out/.simulate.done
else
  input=$drive
fi
map=$out/$name.gpkg
step map "$input" "$roadbook" map "$drive" -m "$map" --replace
step overhead "$out/.map.done" "$roadbook" overhead -m "$map"
step roads "$out/.map.done" "$roadbook" roads -m "$map"
step report "$out/.roads.done" "$roadbook" report -m "$map" -o "$out/report.html"

cat <<END

drive    $drive
map      $map   (a GeoPackage: opens in QGIS)
report   $out/report.html
END
