#!/bin/sh
# Judges the estimator of this commit by a baseline that is committed, for any CI that runs a shell.
#   RCME     the program of this commit (default: rcme of the PATH)
#   BASELINE the result file of the accepted version (default: beside this script)
#   OUT      folder for gate.md, gate.xml and gate.json (default: gate)
# Ends as `rcme gate` does: 0 not worse, 1 worse, 3 undecided, 2 wrong input. UNDECIDED=pass takes 3 for 0.
set -u
RCME=${RCME:-rcme}
OUT=${OUT:-gate}
BASELINE=${BASELINE:-$(dirname "$0")/baseline.sqlite}

"$RCME" gate "$BASELINE" --max-time "${MAX_TIME:-5m}" --out "$OUT" "$@"
code=$?
# A page of GitHub's or of another service that shows Markdown.
if [ -n "${GITHUB_STEP_SUMMARY:-}" ] && [ -f "$OUT/gate.md" ]; then
  cat "$OUT/gate.md" >>"$GITHUB_STEP_SUMMARY"
fi
if [ "$code" -eq 3 ] && [ "${UNDECIDED:-fail}" = pass ]; then
  exit 0
fi
exit "$code"
