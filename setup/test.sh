#!/bin/sh
# Installs what is missing, builds everything, runs all tests. Ends with ctest's summary.
set -eu
cd "$(dirname "$0")/.."
export LC_ALL=C.UTF-8
setup/install.sh
setup/build.sh
# Some tests wait (for a browser, a server, a killed program): three at once fill two cores.
exec ctest --preset release --parallel $(($(nproc) + 1))
