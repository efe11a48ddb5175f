#include "experiments/real/paper_table/paper_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "experiments/core/text/key_value.h"
#include "experiments/data/match_folder.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"
#include "parameters/settings.h"
#include "parameters/text_lines.h"
#include "stats/median_ratio.h"

namespace rcme {
namespace {

// One call for a pair with known motion, with the greater of both errors.
struct PairError {
  std::int64_t member1 = 0, member2 = 0;
  bool is_refused = false;
  double error_deg = 0.0;  // infinite for an invalid motion
};

BoundOutcomes MeasureOutcomes(const std::vector<PairError>& errors, double bound_deg) {
  std::vector<PairEvent> refusal, failure, success;
  std::vector<PairValue> area;
  for (const PairError& e : errors) {
    const bool is_right = !e.is_refused && e.error_deg <= bound_deg;
    refusal.push_back({e.member1, e.member2, e.is_refused});
    failure.push_back({e.member1, e.member2, !e.is_refused && !is_right});
    success.push_back({e.member1, e.member2, is_right});
    area.push_back({e.member1, e.member2, is_right ? 1.0 - e.error_deg / bound_deg : 0.0});
  }
  return {bound_deg, MeasureSharedMemberRate(refusal), MeasureSharedMemberRate(failure),
          MeasureSharedMemberRate(success), MeasureSharedMemberMean(area)};
}

// The events of one estimator on some pairs.
struct CellEvents {
  std::vector<PairEvent> detect_fail, other_refusal, kappa_failure, true_failure, flag_of_failed,
      flag_of_right;
  std::vector<PairError> errors;
  std::vector<double> seconds;

  void Append(const CellEvents& other) {
    for (const auto list : kLists)
      (this->*list).insert((this->*list).end(), (other.*list).begin(), (other.*list).end());
    errors.insert(errors.end(), other.errors.begin(), other.errors.end());
    seconds.insert(seconds.end(), other.seconds.begin(), other.seconds.end());
  }
  TableCell Measure(const std::vector<double>& bounds_deg) const {
    TableCell cell{MeasureSharedMemberRate(detect_fail),
                   MeasureSharedMemberRate(other_refusal),
                   MeasureSharedMemberRate(kappa_failure),
                   MeasureSharedMemberRate(true_failure),
                   MeasureSharedMemberRate(flag_of_failed),
                   MeasureSharedMemberRate(flag_of_right),
                   {},
                   std::numeric_limits<double>::quiet_NaN()};
    for (const double bound_deg : bounds_deg) cell.outcomes.push_back(MeasureOutcomes(errors, bound_deg));
    if (!seconds.empty()) cell.median_seconds = ComputeMedian(seconds);
    return cell;
  }

  static constexpr std::vector<PairEvent> CellEvents::*kLists[] = {
      &CellEvents::detect_fail,  &CellEvents::other_refusal,  &CellEvents::kappa_failure,
      &CellEvents::true_failure, &CellEvents::flag_of_failed, &CellEvents::flag_of_right};
};

// A condition: the names to which patterns apply, and the events of each estimator.
struct SceneEvents {
  std::vector<std::string> levels;
  std::vector<CellEvents> estimators;
  std::int64_t num_in_doubt = 0;
};

// Numbers the images (or scenes) that pairs share, over all scenes.
class Members {
 public:
  explicit Members(TableClusters clusters) : clusters_(clusters) {}
  std::pair<std::int64_t, std::int64_t> Of(const Condition& condition, const StudyPlan& plan,
                                           const std::string& origin) {
    if (clusters_ == TableClusters::kSequences)
      return {Number(condition.index, ""), Number(condition.index, "")};
    const ImageNames& names = FindImageNames(condition, plan);
    const auto found = names.find(origin);
    if (found == names.end()) {
      num_members_ += 2;
      return {num_members_ - 2, num_members_ - 1};
    }
    return {Number(condition.index, found->second.first), Number(condition.index, found->second.second)};
  }

 private:
  // Returns the image names in the condition's folder; a simulated scene has none.
  const ImageNames& FindImageNames(const Condition& condition, const StudyPlan& plan) {
    std::vector<std::string> levels = condition.levels;
    levels.resize(FactorNames(plan.study).size());
    const std::string folder = FindSetting(CombineSettings(plan.study, levels), "folder").value_or("");
    const auto [found, is_new] = names_of_folder_.try_emplace(folder);
    if (is_new && !folder.empty()) found->second = ImageNamesIn(folder);
    return found->second;
  }

  std::int64_t Number(std::uint32_t condition, const std::string& image) {
    const auto [found, is_new] = numbers_.try_emplace({condition, image}, num_members_);
    num_members_ += is_new;
    return found->second;
  }

  TableClusters clusters_;
  std::int64_t num_members_ = 0;
  std::map<std::pair<std::uint32_t, std::string>, std::int64_t> numbers_;
  std::map<std::string, ImageNames> names_of_folder_;
};

// Only estimators that refine a hypothesis count matches before and after refinement.
bool HasFlag(const TrialRecord& record) { return record.num_consistent_before > 0; }

void AddRecord(const TrialRecord& record, bool is_truth_known, const FailureBounds& bounds,
               const std::pair<std::int64_t, std::int64_t>& members, CellEvents* events) {
  const auto add = [&members](std::vector<PairEvent>* list, bool happened) {
    list->push_back({members.first, members.second, happened});
  };
  events->seconds.push_back(record.seconds);
  const bool is_returned = !HasRefused(record), is_detected = record.status == MotionStatus::kNoCandidate;
  const bool is_flagged = is_returned && HasFlag(record) && record.failed_by_kappa;
  add(&events->detect_fail, is_detected);
  add(&events->other_refusal, !is_returned && !is_detected);
  add(&events->kappa_failure, is_flagged);
  if (!is_truth_known) return;
  const bool is_valid = record.status == MotionStatus::kOk;
  const double error_deg = is_valid ? std::fmax(record.rotation_error_deg, record.direction_error_deg)
                                    : std::numeric_limits<double>::infinity();
  events->errors.push_back({members.first, members.second, !is_returned, error_deg});
  add(&events->true_failure, HasFailed(record, bounds));
  if (is_returned && HasFlag(record))
    add(HasFailed(record, bounds) ? &events->flag_of_failed : &events->flag_of_right, is_flagged);
}

// Removes the flag of estimators that never count matches before and after refinement.
void DropMissingFlags(const std::vector<bool>& has_flag, std::vector<SceneEvents>* scenes) {
  for (SceneEvents& scene : *scenes) {
    for (size_t e = 0; e < has_flag.size(); ++e) {
      if (!has_flag[e]) scene.estimators[e].kappa_failure.clear();
    }
  }
}

std::vector<SceneEvents> ListSceneEvents(const ResultStore& run, const StudyPlan& plan,
                                         TableClusters clusters) {
  std::vector<SceneEvents> scenes;
  for (const Condition& condition : plan.conditions)
    scenes.push_back({condition.levels, std::vector<CellEvents>(plan.study.estimators.size()), 0});
  Members members(clusters);
  std::vector<bool> has_flag(plan.study.estimators.size());
  run.ForEachTrial([&](const ProblemRecord& problem, const std::vector<TrialRecord>& records) {
    const Condition& condition = plan.conditions[problem.condition];
    if (records.front().status == MotionStatus::kTruthInDoubt) {
      ++scenes[problem.condition].num_in_doubt;
      return;
    }
    const TrialData data = condition.source->Make(NameOfScene(plan, condition, problem.trial));
    const auto of_pair = members.Of(condition, plan, data.origin);
    for (const TrialRecord& record : records) {
      AddRecord(record, data.truth.cam2_from_cam1_true.has_value(), plan.study.failure, of_pair,
                &scenes[problem.condition].estimators[record.estimator]);
      if (HasFlag(record)) has_flag[record.estimator] = true;
    }
  });
  DropMissingFlags(has_flag, &scenes);
  return scenes;
}

bool Meets(const std::string& pattern, const std::string& name) {
  return pattern.ends_with('*') ? name.starts_with(pattern.substr(0, pattern.size() - 1)) : name == pattern;
}

bool IsInGroup(const SceneGroup& group, const SceneEvents& scene) {
  return std::ranges::any_of(group.patterns, [&](const std::string& pattern) {
    return std::ranges::any_of(scene.levels, [&](const std::string& level) { return Meets(pattern, level); });
  });
}

TableRow MakeTableRow(const std::string& name, bool is_group, const std::vector<const SceneEvents*>& scenes,
                      const std::vector<double>& bounds_deg) {
  TableRow row{name, is_group, {}, 0};
  for (const SceneEvents* scene : scenes) row.num_in_doubt += scene->num_in_doubt;
  for (size_t e = 0; e < scenes.front()->estimators.size(); ++e) {
    CellEvents events;
    for (const SceneEvents* scene : scenes) events.Append(scene->estimators[e]);
    row.cells.push_back(events.Measure(bounds_deg));
  }
  return row;
}

}  // namespace

SceneGroup ParseSceneGroup(const std::string& text) {
  const KeyValue given = SplitKeyValue(text);
  SceneGroup group{given.key, SplitText(given.value, ',')};
  std::erase_if(group.patterns, [](const std::string& pattern) { return pattern.empty(); });
  if (group.name.empty() || group.patterns.empty()) {
    throw InputError(fmt::format(
        "--group: {} is not allowed; give NAME=SCENE,SCENE,..., a scene's name or its beginning with a star",
        Quoted(text)));
  }
  return group;
}

std::vector<SceneGroup> UsualSceneGroups() {
  return {{"indoor", {"euroc*", "EuRoC*", "MH_*", "V1_*", "V2_*", "HRBB4*", "hrbb4*", "tum*", "rgbd*"}},
          {"outdoor", {"kitti*", "KITTI*"}}};
}

PaperTable MakePaperTable(const ResultStore& run, const std::vector<SceneGroup>& groups,
                          TableClusters clusters, const std::vector<double>& bounds_deg) {
  if (run.Description().keeps_counts)
    throw InputError(
        "the run keeps only counts, but the table needs every trial; run it without --keep counts");
  const StudyPlan plan = run.Plan(run.StoredStudy(), PlanEstimators::kNotMade);
  PaperTable table{plan.study.name, ListLabels(plan.study.estimators), plan.study.failure, {}};
  const std::vector<SceneEvents> scenes = ListSceneEvents(run, plan, clusters);
  std::vector<const SceneEvents*> all;
  for (const SceneEvents& scene : scenes) {
    all.push_back(&scene);
    const std::string name = fmt::format("{}", fmt::join(scene.levels, ", "));
    table.rows.push_back(MakeTableRow(name.empty() ? plan.study.name : name, false, {&scene}, bounds_deg));
  }
  for (const SceneGroup& group : groups) {
    std::vector<const SceneEvents*> of_group;
    for (const SceneEvents& scene : scenes) {
      if (IsInGroup(group, scene)) of_group.push_back(&scene);
    }
    if (!of_group.empty()) table.rows.push_back(MakeTableRow(group.name, true, of_group, bounds_deg));
  }
  if (scenes.size() > 1) table.rows.push_back(MakeTableRow("all", true, all, bounds_deg));
  return table;
}

}  // namespace rcme
