#include "experiments/statistics/trial_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "estimator/geometry/essential_matrix.h"
#include "experiments/core/text/columns.h"
#include "experiments/core/text/field_text.h"
#include "experiments/core/text/json_output.h"
#include "experiments/trial/severity_columns.h"
#include "experiments/trial/trial_event.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kMaxSelected = 8;

const Condition& FindCondition(const StudyPlan& plan, const TrialResult& result) {
  return plan.conditions[result.problem.condition];
}

Json Point(const Eigen::Vector3d& point) { return {point.x(), point.y(), point.z()}; }

Json RowMajor(const Eigen::Matrix3d& matrix) {
  const Vector9d numbers = Vectorize(matrix);
  return std::vector<double>(numbers.begin(), numbers.end());
}

Json FundamentalAsJson(const RelativePose& pose, const Camera& camera1, const Camera& camera2) {
  return RowMajor(FundamentalFromEssential(EssentialFromPose(pose), camera1, camera2));
}

// The centre of camera 2 in the frame of camera 1.
Eigen::Vector3d Centre2(const RelativePose& cam2_from_cam1, double baseline_m) {
  return -baseline_m * (cam2_from_cam1.R.transpose() * cam2_from_cam1.t);
}

Json CameraAsJson(const Camera& camera) {
  return {{"fx", camera.fx}, {"fy", camera.fy},       {"cx", camera.cx},
          {"cy", camera.cy}, {"width", camera.width}, {"height", camera.height}};
}

Json ViewAsJson(const Eigen::Vector3d& centre_in_cam1, const Eigen::Matrix3d& cam1_from_cam,
                const Camera& camera) {
  const Eigen::Vector3d left = cam1_from_cam * camera.Ray({-0.5, camera.cy});
  const Eigen::Vector3d right = cam1_from_cam * camera.Ray({camera.width - 0.5, camera.cy});
  const Eigen::Vector3d upper = cam1_from_cam * camera.Ray({camera.cx, -0.5});
  const Eigen::Vector3d lower = cam1_from_cam * camera.Ray({camera.cx, camera.height - 0.5});
  return {{"centre_in_cam1_m", Point(centre_in_cam1)},
          {"edges_in_cam1", {Point(left), Point(right), Point(upper), Point(lower)}}};
}

// The true cameras; the scene is null for real pairs.
struct TrueSetting {
  Camera camera1, camera2;
  std::optional<Scene> scene;

  TrueSetting(const StudyPlan& plan, const TrialResult& result)
      : camera1(result.data.problem.camera1), camera2(result.data.problem.camera2) {
    const Condition& condition = FindCondition(plan, result);
    scene = condition.source->FindScene(NameOfScene(plan, condition, result.problem.trial));
    if (!scene) return;
    camera1 = scene->camera1;
    camera2 = scene->camera2;
  }
};

void AddScene(const TrueSetting& setting, const std::vector<std::uint32_t>& scene_point, Json* json) {
  Json points, views;
  if (const std::optional<Scene>& scene = setting.scene) {
    const RelativePose& pose = scene->cam2_from_cam1_true;
    points = Json::array();
    for (const std::uint32_t index : scene_point) points.push_back(Point(scene->points_in_cam1[index]));
    views = {ViewAsJson(Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity(), scene->camera1),
             ViewAsJson(Centre2(pose, scene->baseline_m), pose.R.transpose(), scene->camera2)};
  }
  (*json)["points_in_cam1_m"] = points;
  (*json)["views"] = views;
}

Json TruthAsJson(const TrueSetting& setting, const Truth& truth) {
  if (!truth.cam2_from_cam1_true) return nullptr;
  const RelativePose& pose = *truth.cam2_from_cam1_true;
  const bool is_known = truth.is_direction_known;
  return {{"R", RowMajor(pose.R)},
          {"t", is_known ? Point(pose.t) : Json()},
          {"baseline_m", setting.scene ? Json(setting.scene->baseline_m) : Json()},
          {"F", is_known ? FundamentalAsJson(pose, setting.camera1, setting.camera2) : Json()}};
}

Json KindsAsJson(const Truth& truth) {
  if (truth.is_inlier_true.empty()) return nullptr;
  Json kinds = Json::array();
  for (size_t i = 0; i < truth.is_inlier_true.size(); ++i) {
    const bool is_undetectable = !truth.is_undetectable.empty() && truth.is_undetectable[i];
    kinds.push_back(truth.is_inlier_true[i] ? "inlier" : is_undetectable ? "undetectable" : "outlier");
  }
  return kinds;
}

// Returns the matches whose epipolar lines are most informative: true inliers; if these are unknown, the
// inliers of a drawn estimator; if there are none, all matches.
std::vector<int> ListCandidates(const TrialResult& result, const std::vector<size_t>& drawn) {
  const std::vector<bool>& is_inlier = result.data.truth.is_inlier_true;
  for (const size_t e : drawn) {
    if (is_inlier.empty() && !result.estimates[e].inliers.empty()) return result.estimates[e].inliers;
  }
  std::vector<int> candidates;
  for (size_t i = 0; i < result.data.problem.matches.size(); ++i) {
    if (is_inlier.empty() || is_inlier[i]) candidates.push_back(static_cast<int>(i));
  }
  return candidates;
}

// Begins with the first candidate and always adds the one farthest in image 1 from those selected before.
std::vector<int> SpreadOver(const std::vector<Correspondence>& matches, const std::vector<int>& candidates) {
  std::vector<int> selected;
  std::vector<double> distance_px(candidates.size(), std::numeric_limits<double>::infinity());
  while (selected.size() < std::min(kMaxSelected, candidates.size())) {
    const auto farthest = std::ranges::max_element(distance_px) - distance_px.begin();
    selected.push_back(candidates[static_cast<size_t>(farthest)]);
    const Eigen::Vector2d& chosen_px = matches[static_cast<size_t>(selected.back())].x1_px;
    for (size_t k = 0; k < candidates.size(); ++k) {
      const Eigen::Vector2d& x1_px = matches[static_cast<size_t>(candidates[k])].x1_px;
      distance_px[k] = std::min(distance_px[k], (x1_px - chosen_px).norm());
    }
  }
  return selected;
}

// Returns the winning hypothesis: its sample, and the number of the solver's model. Null without one.
Json HypothesisAsJson(const HypothesisId& id) {
  if (id.sample.size() == 0) return nullptr;
  return {{"sample", std::vector<int>(id.sample.begin(), id.sample.end())}, {"model", id.model}};
}

Json EstimateAsJson(const StudyPlan& plan, const TrialResult& result, size_t e, double baseline_m) {
  const MotionEstimate& estimate = result.estimates[e];
  const TrialRecord& record = result.records[e];
  Json json = {{"label", plan.study.estimators[e].label},
               {"status", StatusName(estimate.status)},
               {"message", estimate.message},
               {"outcome", Name(ClassifyOutcome(record, plan.study.failure))},
               {"rotation_error_deg", JsonNumber(record.rotation_error_deg)},
               {"direction_error_deg", JsonNumber(record.direction_error_deg)},
               {"inlier_precision", JsonNumber(record.inlier_precision)},
               {"inlier_recall", JsonNumber(record.inlier_recall)},
               {"hypothesis", HypothesisAsJson(estimate.hypothesis)},
               {"inliers", estimate.inliers}};
  for (const char* key : {"R", "t", "F", "centre2_in_cam1_m"}) json[key] = nullptr;
  if (estimate.status != MotionStatus::kOk) return json;
  const RelativePose& pose = estimate.cam2_from_cam1;
  json["R"] = RowMajor(pose.R);
  json["t"] = Point(pose.t);
  json["F"] = FundamentalAsJson(pose, result.data.problem.camera1, result.data.problem.camera2);
  if (baseline_m > 0.0) json["centre2_in_cam1_m"] = Point(Centre2(pose, baseline_m));
  return json;
}

Json MatchesAsJson(const std::vector<Correspondence>& matches) {
  Json rows = Json::array();
  for (const Correspondence& m : matches)
    rows.push_back({m.x1_px.x(), m.x1_px.y(), m.x2_px.x(), m.x2_px.y()});
  return rows;
}

Json Header(const StudyPlan& plan, const TrialResult& result) {
  const Condition& condition = FindCondition(plan, result);
  Json factors = Json::array(), parts = Json::array(), bounds = Json::object(), severity = Json::object();
  for (size_t f = 0; f < plan.factor_names.size(); ++f) {
    factors.push_back(Json::array({plan.factor_names[f], condition.levels[f]}));
  }
  for (const auto& [part, name] : condition.source->ChosenParts()) parts.push_back(Json::array({part, name}));
  bounds["max_rotation_error_deg"] = plan.study.failure.max_rotation_error_deg;
  bounds["max_direction_error_deg"] = plan.study.failure.max_direction_error_deg;
  for (const SeverityColumn& column : kSeverityColumns)
    severity[column.name] = JsonNumber(result.problem.severity.*column.field);
  return {{"study", plan.study.name},
          {"seed", plan.study.seed},
          {"condition", condition.index},
          {"trial", result.problem.trial},
          {"trials_planned", condition.num_trials},
          {"factors", factors},
          {"parts", parts},
          {"origin", result.data.origin},
          {"sigma_px", result.data.problem.sigma_px},
          {"bounds", bounds},
          {"severity", severity}};
}

std::string Percentage(double share) {
  return std::isnan(share) ? "-" : fmt::format("{:.1f} %", 100.0 * share);
}

std::string Degrees(double angle_deg) {
  return std::isnan(angle_deg) ? "-" : fmt::format("{:.3g} deg", angle_deg);
}

std::string DescribeMatches(const TrialData& data) {
  std::string words = fmt::format("{} matches", data.problem.matches.size());
  const std::vector<bool>& is_inlier = data.truth.is_inlier_true;
  if (!is_inlier.empty()) {
    const auto num_true = std::ranges::count(is_inlier, true);
    words +=
        fmt::format(": {} true, {} wrong ({} of them on their true epipolar line)", num_true,
                    std::ssize(is_inlier) - num_true, std::ranges::count(data.truth.is_undetectable, true));
  }
  return words + fmt::format("; assumed sigma {} px", data.problem.sigma_px);
}

}  // namespace

size_t MostTelling(const StudyPlan& plan, const TrialResult& result) {
  const auto is_telling = [&](const TrialRecord& record) {
    return HasFailedOrRefused(record, plan.study.failure);
  };
  const auto found = std::ranges::find_if(result.records, is_telling);
  return found == result.records.end() ? 0 : static_cast<size_t>(found - result.records.begin());
}

std::string TrialAsJson(const StudyPlan& plan, const TrialResult& result, const std::vector<size_t>& drawn) {
  const TrialData& data = result.data;
  const TrueSetting setting(plan, result);
  Json json = Header(plan, result);
  json["cameras"] = {CameraAsJson(setting.camera1), CameraAsJson(setting.camera2)};
  json["matches"] = MatchesAsJson(data.problem.matches);
  json["kinds"] = KindsAsJson(data.truth);
  AddScene(setting, data.scene_point, &json);
  json["truth"] = TruthAsJson(setting, data.truth);
  json["selected"] = SpreadOver(data.problem.matches, ListCandidates(result, drawn));
  json["drawn"] = drawn;
  json["estimators"] = Json::array();
  for (size_t e = 0; e < result.estimates.size(); ++e) {
    json["estimators"].push_back(
        EstimateAsJson(plan, result, e, setting.scene ? setting.scene->baseline_m : 0.0));
  }
  return JsonText(kTrialFormat, json);
}

std::string TrialAsText(const StudyPlan& plan, const TrialResult& result) {
  const Condition& condition = FindCondition(plan, result);
  const std::uint32_t trial = result.problem.trial;
  std::string text = fmt::format("Study {}, seed {}, condition {}, trial {} ({})\n", plan.study.name,
                                 plan.study.seed, condition.index, trial, result.data.origin);
  if (std::cmp_greater_equal(trial, condition.num_trials)) {
    text += fmt::format("  beyond the {} trials the study asks for: it is what more trials would add\n",
                        condition.num_trials);
  }
  for (size_t f = 0; f < plan.factor_names.size(); ++f) {
    text += fmt::format("  {} = {}\n", plan.factor_names[f], condition.levels[f]);
  }
  std::string parts;
  for (const auto& [part, name] : condition.source->ChosenParts()) {
    parts += fmt::format("{}{} {}", parts.empty() ? "  " : ", ", part, name);
  }
  text += fmt::format("{}{}  {}\n", parts, parts.empty() ? "" : "\n", DescribeMatches(result.data));
  for (const SeverityColumn& column : kSeverityColumns) {
    const double value = result.problem.severity.*column.field;
    if (!std::isnan(value)) text += fmt::format("  {:<24}{:.4g}\n", column.name, value);
  }
  std::vector<std::vector<std::string>> rows = {{"estimator", "outcome", "status", "rotation error",
                                                 "direction error", "inliers", "precision", "recall"}};
  for (size_t e = 0; e < result.records.size(); ++e) {
    const TrialRecord& r = result.records[e];
    rows.push_back({plan.study.estimators[e].label, Name(ClassifyOutcome(r, plan.study.failure)),
                    StatusName(r.status), Degrees(r.rotation_error_deg), Degrees(r.direction_error_deg),
                    fmt::format("{}", r.num_inliers), Percentage(r.inlier_precision),
                    Percentage(r.inlier_recall)});
  }
  return text + "\n" + FormatColumns(rows);
}

}  // namespace rcme
