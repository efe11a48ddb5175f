#!/bin/sh
# Installs the build into a scratch prefix, builds examples/own_estimator against it as a user would, and runs its contract,
# its audit and its study: the estimator that the example adds must be in all of them.
#   own_estimator_test.sh CMAKE BUILD_DIR
set -eu
cmake=$1
build=$2
root=$(cd "$(dirname "$0")/../.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$cmake" --install "$build" --prefix "$scratch/prefix" >/dev/null
"$cmake" -G Ninja -S "$root/examples/own_estimator" -B "$scratch/own" -DCMAKE_PREFIX_PATH="$scratch/prefix" \
  -DCMAKE_BUILD_TYPE=Release >/dev/null
"$cmake" --build "$scratch/own"
own=$scratch/own/own_rcme

"$own" list estimators | grep -q '^opencv '
"$own" check-estimator opencv
"$own" audit --only estimator.coverage.opencv --out "$scratch/audit" | grep '^estimator.coverage.opencv '
grep -q '"id": "estimator.coverage.opencv"' "$scratch/audit/audit.json"
test -s "$scratch/audit/audit_estimator.png"

"$own" run "$root/examples/own_estimator/failures.yaml" --trials 2 --out "$scratch/own.sqlite"
"$own" summarize "$scratch/own.sqlite" --format csv --out "$scratch/own.csv"
grep -q ',opencv,failure,' "$scratch/own.csv"
"$own" plot failure_rate "$scratch/own.csv" --x outlier_ratio \
  --out "$scratch/own_failures"
test -s "$scratch/own_failures.png"
