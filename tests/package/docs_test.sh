#!/bin/sh
# docs_test.sh SOURCE_FOLDER DOXYGEN: makes the documentation in a folder of its own.
set -eu
cd "$1"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
{ cat setup/Doxyfile; echo "OUTPUT_DIRECTORY = $work"; } > "$work/Doxyfile"
"$2" "$work/Doxyfile"
test -s "$work/html/index.html"
test -s "$work/html/structroadbook_1_1Map.html"
