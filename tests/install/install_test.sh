#!/bin/sh
# Installs the build into a scratch prefix, then builds and runs a small project that finds it with find_package(rcme).
#   install_test.sh CMAKE BUILD_DIR
set -eu
cmake=$1
build=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$cmake" --install "$build" --prefix "$scratch/prefix" >/dev/null
"$scratch/prefix/bin/rcme" --version
"$cmake" -G Ninja -S "$(dirname "$0")/consumer" -B "$scratch/consumer" -DCMAKE_PREFIX_PATH="$scratch/prefix" \
  -DCMAKE_BUILD_TYPE=Release >/dev/null
"$cmake" --build "$scratch/consumer"
"$scratch/consumer/consumer"
