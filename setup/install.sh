#!/bin/sh
# Installs the Debian packages of setup/packages.txt that are not there yet; as root, or with sudo.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
export DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8

missing=
for package in $(sed 's/#.*//' "$here/packages.txt"); do
  status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
  # A program of that name from elsewhere does as well (and may not go with the package).
  [ "$status" = installed ] || command -v "$package" >/dev/null || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

as_root=
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || {
    echo "error: packages are missing:$missing: got a user without sudo, want root or sudo" >&2
    exit 1
  }
  as_root="sudo DEBIAN_FRONTEND=noninteractive"
fi
install_missing() {
  # shellcheck disable=SC2086 # both are lists of words
  $as_root apt-get install -y -q --no-install-recommends $missing
}
echo "installing:$missing"
# A bare machine has no package lists at all; old lists may name files that are gone.
# shellcheck disable=SC2086
if apt-cache show --no-all-versions $missing >/dev/null 2>&1 && install_missing; then
  exit 0
fi
$as_root apt-get update -q
install_missing
