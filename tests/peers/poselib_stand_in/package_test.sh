#!/bin/sh
# Where CMake finds PoseLib, the adapter and its line in the registry are part of the room: a build that finds the stand-in
# compiles both, here each by itself.
#   package_test.sh CMAKE
set -eu
here=$(cd "$(dirname "$0")" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$1" -G Ninja -S "$here/../../.." -B "$scratch" -DPoseLib_DIR="$here" -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS=-O0 \
  -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON -DRCME_BUILD_TESTS=OFF -DRCME_BUILD_BENCHMARKS=OFF >/dev/null
objects=peers/CMakeFiles/rcme_peers.dir
"$1" --build "$scratch" --target $objects/poselib.cc.o --target $objects/peer_registry.cc.o
grep -q 'PoseLib 2.0.5: estimate_relative_pose' "$scratch/$objects/peer_registry.cc.o"
