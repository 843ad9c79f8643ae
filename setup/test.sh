#!/bin/sh
# Installs what is missing, builds everything, runs all tests. Ends with ctest's summary.
set -eu
cd "$(dirname "$0")/.."
export LC_ALL=C.UTF-8
setup/install.sh
setup/build.sh
exec ctest --preset release --parallel 2
