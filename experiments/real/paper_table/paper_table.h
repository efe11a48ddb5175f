// The table of the paper for a run of one's own: refusals and failures per sequence, by the paper's flag and
// by the truth where there is one.
#pragma once

#include <string>
#include <vector>

#include "experiments/run/store/result_store.h"
#include "stats/shared_members.h"

namespace rcme {

// Scenes that the table also counts together. A pattern is the name of a scene, or its beginning with a star.
struct SceneGroup {
  std::string name;
  std::vector<std::string> patterns;
};
// "indoor=MH_*,room" as text. Throws InputError that says what is allowed.
SceneGroup ParseSceneGroup(const std::string& text);
// By the names of the public data sets.
std::vector<SceneGroup> UsualSceneGroups();

// What pairs have in common that makes them dependent.
enum class TableClusters {
  kImages,    // pairs of a scene that share an image; pairs without names of images are independent
  kSequences  // all pairs of a scene
};

// What became of the pairs whose motion is known, by the greater of rotation and direction error e: the three
// rates add up to 1.
struct BoundOutcomes {
  double bound_deg = 0.0;
  SharedMemberRate refusal;  // no motion
  SharedMemberRate failure;  // e above the bound, or an answer that is not valid
  SharedMemberRate success;
  SharedMemberMean area;  // AUC: of max(0, 1 - e / bound), 0 without a success
};

// One estimator on one scene or group. Rates of all pairs, but where a line says otherwise; intervals respect
// what pairs have in common (shared_members.h).
struct TableCell {
  SharedMemberRate detect_fail;    // no candidate: the paper's Detect-fail
  SharedMemberRate other_refusal;  // no motion for any other reason
  SharedMemberRate kappa_failure;  // the paper's Failure: n*_I / n_I <= kappa; n = 0 where there is no flag
  SharedMemberRate true_failure;   // motion beyond a bound or not valid; of pairs whose motion is known
  // The flag against the truth, of returned motions with both.
  SharedMemberRate flag_of_failed, flag_of_right;
  std::vector<BoundOutcomes> outcomes;  // of each bound that was asked for
  double median_seconds = 0.0;          // of a call; NaN without pairs
};

struct TableRow {
  std::string name;
  bool is_group = false;
  std::vector<TableCell> cells;   // one per estimator of the study
  std::int64_t num_in_doubt = 0;  // pairs whose truth is listed as in doubt: in no cell
};

struct PaperTable {
  std::string study;
  std::vector<std::string> estimators;
  FailureBounds bounds;
  std::vector<TableRow> rows;  // the scenes, then the groups that have any, then all
};

// Reads the pairs again, for the names of their images. Throws InputError if they are gone or have changed.
// `bounds_deg`: those of the outcomes.
PaperTable MakePaperTable(const ResultStore& run, const std::vector<SceneGroup>& groups,
                          TableClusters clusters, const std::vector<double>& bounds_deg = {});

}  // namespace rcme
