#!/bin/sh
# races.sh [NUMBER]: holds each verb that writes a map at NUMBER moments (20) while another one
# writes the same map. Needs the tests of a release build; takes minutes.
set -eu
cd "$(dirname "$0")/.."
ROADBOOK_RACES="${1:-20}" build/release/tests/apps/test_races --gtest_filter='MapRaces*'
