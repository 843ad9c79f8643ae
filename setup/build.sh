#!/bin/sh
# Configures and builds in build/release (Release, Ninja): setup/build.sh [TARGET...], default all.
set -eu
cd "$(dirname "$0")/.."
export LC_ALL=C.UTF-8
if [ ! -f build/release/build.ninja ]; then
  cmake --preset release -DROADBOOK_BUILD_BENCH=OFF
fi
cmake --build --preset release --parallel "$(nproc)" ${1:+--target "$@"}
