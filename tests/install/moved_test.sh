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

# No file that is installed holds the source folder, the build folder (by any of their names) or the first prefix. Planted
# files show that the search can fail: a path amid other bytes, at the end of a file, in pieces in a program, and a short one.
python=$("$root/scripts/find-python")
find_paths() { "$python" -B "$root/tests/install/paths_in_files.py" "$@"; }
find_paths "$scratch/moved" "$root" "$(cd "$root" && pwd -P)" "$build" "$(cd "$build" && pwd -P)" "$scratch/first" ||
  fail "the files above hold a path of the source tree, the build or the first prefix"
planted=$scratch/planted
mkdir "$planted" "$planted/deep"
if ! find_paths "$planted" /build/of/rcme /src; then fail "a path is found in a folder without files"; fi
printf 'a\0\377-I/build/of/rcme/x\0' >"$planted/amid"
printf 'share/rcme\n/build/of/rcme' >"$planted/deep/.end"
printf '"/src"' >"$planted/short"
printf '/build/of/rcm, /usr/src, /src-2' >"$planted/none"
printf '/of/rcme\0\0/srv/bui\0' >pieces
objcopy --add-section .planted=pieces /bin/true "$planted/pieces"
find_paths "$planted" /build/of/rcme /src >found && fail "what was planted is not found"
find_paths "$planted" /srv/bui/of/rcme >>found && fail "what was planted in pieces is not found"
sed "s|^$planted/||" found >names
printf '%s holds %s\n' amid /build/of/rcme deep/.end /build/of/rcme short /src pieces /srv/bui/of/rcme >wanted
cmp wanted names || { cat found >&2; fail "not exactly what was planted is found"; }

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
