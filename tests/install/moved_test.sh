#!/bin/sh
# Installs the build into a scratch prefix and moves that: the program must find its studies, estimator files and plots where
# they are now, and hold no path of the folders it was built in.
#   moved_test.sh CMAKE BUILD_DIR
set -eu
cmake=$1
build=$2
root=$(cd "$(dirname "$0")/../.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$cmake" --install "$build" --prefix "$scratch/first" >/dev/null
mv "$scratch/first" "$scratch/moved"
rcme=$scratch/moved/bin/rcme
plots=$scratch/moved/share/rcme/plots
mkdir "$scratch/work"
cd "$scratch/work"

fail() {
  echo "moved_test: $1" >&2
  exit 1
}
# Fails unless the command ends with 2 and says so.
refused() {
  words=$1
  shift
  status=0
  "$@" >out 2>err || status=$?
  [ "$status" = 2 ] && grep -qF "$words" err || { cat err >&2; fail "$*: ended with $status, not with 2 and '$words'"; }
}

# A debug build names its sources for the debugger alone.
strip -o stripped "$rcme"
if grep -qF -e "$root" -e "$scratch/first" stripped; then fail "the program holds a path of its source tree or first prefix"; fi
if grep -rlF -e "$root" -e "$scratch/first" "$scratch/moved/lib" --include='*.cmake'; then fail "these hold such a path"; fi

"$rcme" list studies | grep -q '^failure_vs_outliers '
"$rcme" list estimator_files | grep -q '^rcme_tuned '
"$rcme" run failure_vs_outliers --add-estimator rcme_tuned --trials 2 --out run.sqlite 2>err || { cat err >&2; fail run; }
"$rcme" summarize run.sqlite --format csv --out summary.csv
"$rcme" report run.sqlite --out report.html 2>err || { cat err >&2; fail report; }
test -s report.html
"$rcme" plot failure_rate summary.csv --x outlier_ratio --out figure >out 2>err || { cat err >&2; fail plot; }
test -s figure.png

# What is missing here is taken from nowhere else.
rm "$scratch/moved/share/rcme/studies/failure_vs_outliers.yaml" "$plots/failure_rate.py"
refused "failure_vs_outliers: no such study" "$rcme" run failure_vs_outliers --trials 2 --out other.sqlite
refused "$plots/failure_rate.py" "$rcme" plot failure_rate summary.csv --x outlier_ratio --out again
rm -r "$plots"
refused "share/rcme/plots" "$rcme" report run.sqlite --out again.html
