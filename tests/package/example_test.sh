#!/bin/sh
# example_test.sh BUILD_FOLDER SOURCE_FOLDER CMAKE: installs, builds examples/map_drive, runs it.
set -eu
build=$1
source=$2
cmake=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$cmake" --install "$build" --prefix "$work/prefix" >/dev/null
# The example sees the installed headers alone.
cp -r "$source/examples/map_drive" "$work/example"
"$cmake" -S "$work/example" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_PREFIX_PATH="$work/prefix" >/dev/null
"$cmake" --build "$work/build" >/dev/null

"$work/prefix/bin/roadbook" simulate zurich --size small --image-scale 0.5 --max-duration-s 8 \
  -o "$work/drive" -q
"$work/build/map_drive" "$work/drive" "$work/map.gpkg" | tee "$work/said"
grep -q "^pose at .* standard deviation 0\.0" "$work/said"
# The command reads what the library wrote, and counts the same.
keyframes=$(sed -n 's/ keyframes.*//p' "$work/said")
"$work/prefix/bin/roadbook" map "$work/drive" -m "$work/map.gpkg" --json -q > "$work/summary.json"
grep -q "\"keyframes\": *$keyframes" "$work/summary.json"
grep -q '"unchanged": *true' "$work/summary.json"
