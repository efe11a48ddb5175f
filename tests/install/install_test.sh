#!/bin/sh
# Installs the build into a scratch prefix and moves that, then builds and runs a small project that finds it with find_package(rcme).
#   install_test.sh CMAKE BUILD_DIR [PREFIXES]    (where the build found its libraries, separated by semicolons)
set -eu
cmake=$1
build=$2
prefixes=${3-}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$cmake" --install "$build" --prefix "$scratch/first" >/dev/null
mv "$scratch/first" "$scratch/prefix"
"$scratch/prefix/bin/rcme" --version

# Studies and estimator files by their names, manual pages and completion, wherever the program was put.
(cd / && "$scratch/prefix/bin/rcme" list studies | grep -q '^failure_vs_outliers ')
test -s "$scratch/prefix/share/rcme/estimator_files/rcme_tuned.yaml"
test -s "$scratch/prefix/share/rcme/study.schema.json"
rm "$scratch/prefix/share/rcme/studies/failure_vs_outliers.yaml"
if (cd / && "$scratch/prefix/bin/rcme" list studies | grep -q '^failure_vs_outliers '); then exit 1; fi  # these, not the source tree's
grep -q 'RCME' "$scratch/prefix/share/man/man1/rcme-run.1"
grep -q summarize "$scratch/prefix/share/bash-completion/completions/rcme"
test -s "$scratch/prefix/share/zsh/site-functions/_rcme"
test -s "$scratch/prefix/share/fish/vendor_completions.d/rcme.fish"
"$cmake" -G Ninja -S "$(dirname "$0")/consumer" -B "$scratch/consumer" -DCMAKE_PREFIX_PATH="$scratch/prefix;$prefixes" \
  -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE="-O1 -DNDEBUG" >/dev/null
"$cmake" --build "$scratch/consumer"
"$scratch/consumer/consumer"
# The example for a robot, which needs one header.
root=$(cd "$(dirname "$0")/../.." && pwd)
"$cmake" -G Ninja -S "$root/examples/robot" -B "$scratch/robot" -DCMAKE_PREFIX_PATH="$scratch/prefix;$prefixes" \
  -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE="-O1 -DNDEBUG" >/dev/null
"$cmake" --build "$scratch/robot"
"$scratch/robot/robot_example"
