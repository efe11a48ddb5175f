#!/bin/sh
# Installs the build into a scratch prefix and moves that, builds examples/own_estimator against it as a user would, and runs its contract,
# its audit and its study: the estimator that the example adds must be in all of them.
#   own_estimator_test.sh CMAKE BUILD_DIR [PREFIXES]    (where the build found its libraries, separated by semicolons)
set -eu
cmake=$1
build=$2
prefixes=${3-}
root=$(cd "$(dirname "$0")/../.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$cmake" --install "$build" --prefix "$scratch/first" >/dev/null
mv "$scratch/first" "$scratch/prefix"
"$cmake" -G Ninja -S "$root/examples/own_estimator" -B "$scratch/own" -DCMAKE_PREFIX_PATH="$scratch/prefix;$prefixes" \
  -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE="-O1 -DNDEBUG" >/dev/null
"$cmake" --build "$scratch/own"
own=$scratch/own/own_rcme

"$own" list estimators | grep -q '^opencv '
"$own" list studies | grep -q '^failure_vs_outliers '  # those of the installation that it was built with
"$own" check-estimator opencv
"$own" audit --only estimator.sigma.opencv --out "$scratch/audit" | grep '^estimator.sigma.opencv '
grep -q '"id": "estimator.sigma.opencv"' "$scratch/audit/audit.json"
test -s "$scratch/audit/audit_estimator.png"

"$own" run "$root/examples/own_estimator/failures.yaml" --trials 1 --out "$scratch/own.sqlite"
"$own" summarize "$scratch/own.sqlite" --format csv --out "$scratch/own.csv"
grep -q ',opencv,failure,' "$scratch/own.csv"
grep -q ',opencv_careful,failure,' "$scratch/own.csv"
"$own" plot failure_rate "$scratch/own.csv" --x outlier_ratio \
  --out "$scratch/own_failures"
test -s "$scratch/own_failures.png"

# Its options: in a study (above), on the command line, in a block `tune`; no others.
"$own" list options | grep -q '^opencv  *min_inliers '
"$own" check-estimator opencv --set threshold_sigmas=3 --only repeatable
awk 'BEGIN { print "# size1: 640 480\n# size2: 640 480"
  print "# K1_fx_fy_cx_cy: 600 600 319.5 239.5\n# K2_fx_fy_cx_cy: 600 600 319.5 239.5"
  for (i = 0; i < 60; ++i) { x = 100 + 37 * i % 400; y = 100 + 91 * i % 250; z = 4 + 17 * i % 8
    print x "," y "," x + 480 / z "," y + 360 / z } }' >"$scratch/matches.csv"
"$own" estimate "$scratch/matches.csv" --estimator opencv --set min_inliers=60 | grep -q '60 of 60'
"$own" estimate "$scratch/matches.csv" --estimator opencv --set min_inliers=61 | grep -q no_candidate
if "$own" check-estimator opencv --set mu=1 2>"$scratch/refusal"; then exit 1; fi
grep -q "estimator opencv has no option 'mu'; its options: threshold_sigmas, confidence, min_inliers" "$scratch/refusal"
# With few wrong matches, of which OpenCV's search is over at once.
"$own" tune "$root/examples/own_estimator/failures.yaml" --set outlier_ratio=0.1 --tune explore=2 --tune calibrate=4 --tune verify=2 \
  --out "$scratch/tuned.yaml"
grep -q '^  min_inliers: ' "$scratch/tuned.yaml"

# The plain program reads what the own one wrote, but does not run it.
rcme=$scratch/prefix/bin/rcme
"$rcme" summarize "$scratch/own.sqlite" --format csv --out "$scratch/plain.csv"
cmp "$scratch/own.csv" "$scratch/plain.csv"
"$rcme" compare "$scratch/own.sqlite" | grep -q opencv_careful
if "$rcme" replay "$scratch/own.sqlite" --condition 0 --trial 0 2>"$scratch/refusal"; then exit 1; fi
grep -q "unknown estimator 'opencv'.*made by own_rcme (rcme " "$scratch/refusal"
