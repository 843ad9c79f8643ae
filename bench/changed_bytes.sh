#!/bin/sh
# changed_bytes.sh MAP [NUMBER]: changes NUMBER bytes (1000) of a copy of MAP, one at a time, and
# counts those that `check` finds. Needs the tests of a release build.
set -eu
map=$(readlink -f "$1")
cd "$(dirname "$0")/.."
ROADBOOK_DAMAGED_MAP="$map" ROADBOOK_DAMAGES="${2:-1000}" \
  build/release/tests/mapping/store/test_store --gtest_filter=MapDamage.EveryChangedByteIsFound
