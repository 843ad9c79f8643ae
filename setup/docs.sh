#!/bin/sh
# API documentation from the headers: build/docs/html/index.html. Ends with status 1 if Doxygen warns.
set -eu
cd "$(dirname "$0")/.."
export LC_ALL=C.UTF-8
setup/install.sh
mkdir -p build/docs
doxygen setup/Doxyfile
echo "build/docs/html/index.html"
