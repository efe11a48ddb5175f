// The table of the paper for your own run: refusals and failures per sequence, by the paper's flag and, if
// it is known, by the truth.
#pragma once

#include <string>
#include <vector>

#include "experiments/run/store/result_store.h"
#include "stats/shared_members.h"

namespace rcme {

// Scenes that the table also counts together. A pattern is the name of a scene, or the beginning of a name
// and a star.
struct SceneGroup {
  std::string name;
  std::vector<std::string> patterns;
};
// Parses "indoor=MH_*,room". Throws InputError that says what is allowed.
SceneGroup ParseSceneGroup(const std::string& text);
// Returns groups for the names of the public data sets.
std::vector<SceneGroup> UsualSceneGroups();

// Which pairs depend on each other.
enum class TableClusters {
  kImages,    // pairs of a scene that share an image; pairs without image names are independent
  kSequences  // all pairs of a scene
};

// Outcomes of the pairs whose true motion is known. e is the greater of rotation and direction error. The
// three rates add up to 1.
struct BoundOutcomes {
  double bound_deg = 0.0;
  SharedMemberRate refusal;  // no motion
  SharedMemberRate failure;  // e above the bound, or an invalid answer
  SharedMemberRate success;
  SharedMemberMean area;  // AUC: mean of max(0, 1 - e / bound), 0 without a success
};

// One estimator on one scene or group. Rates are over all pairs unless stated otherwise; intervals account
// for dependent pairs (shared_members.h).
struct TableCell {
  SharedMemberRate detect_fail;    // no candidate: the paper's Detect-fail
  SharedMemberRate other_refusal;  // no motion for any other reason
  SharedMemberRate kappa_failure;  // the paper's Failure: n*_I / n_I <= kappa; n = 0 without a flag
  SharedMemberRate true_failure;   // a motion beyond a bound or invalid; of pairs whose motion is known
  // The flag compared with the truth, for returned motions that have both.
  SharedMemberRate flag_of_failed, flag_of_right;
  std::vector<BoundOutcomes> outcomes;  // for each requested bound
  double median_seconds = 0.0;          // per call; NaN without pairs
};

struct TableRow {
  std::string name;
  bool is_group = false;
  std::vector<TableCell> cells;   // one per estimator of the study
  std::int64_t num_in_doubt = 0;  // pairs listed as in doubt; no cell counts them
};

struct PaperTable {
  std::string study;
  std::vector<std::string> estimators;
  FailureBounds bounds;
  std::vector<TableRow> rows;  // the scenes, then the non-empty groups, then all
};

// Makes the table. It reads the pairs again for the names of their images; throws InputError if they are
// missing or have changed. `bounds_deg`: the bounds of the outcomes.
PaperTable MakePaperTable(const ResultStore& run, const std::vector<SceneGroup>& groups,
                          TableClusters clusters, const std::vector<double>& bounds_deg = {});

}  // namespace rcme
