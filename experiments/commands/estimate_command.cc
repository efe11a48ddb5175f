#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "estimator/ransac_estimator.h"
#include "experiments/base/field_text.h"
#include "experiments/base/json_output.h"
#include "experiments/commands/commands.h"
#include "experiments/commands/estimator_source.h"
#include "experiments/commands/number_option.h"
#include "experiments/data/match_file.h"
#include "experiments/trial/answer_check.h"
#include "experiments/trial/trial.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

struct EstimateArguments {
  std::string matches;
  EstimatorChoice estimator;
  double sigma_px = 0.5;
  std::int64_t seed = 1;
  bool as_json = false;
};

// The row-major numbers of a matrix.
std::vector<double> RowMajor(const Eigen::MatrixXd& matrix) {
  std::vector<double> numbers;
  for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
    for (Eigen::Index c = 0; c < matrix.cols(); ++c) numbers.push_back(matrix(r, c));
  }
  return numbers;
}

// Of an estimator that states them; see motion_estimate.h.
void AddProbabilities(const MotionEstimate& estimate, nlohmann::ordered_json* json) {
  (*json)["failure_probability"] = estimate.failure_probability;
  (*json)["sigma_estimated_px"] = estimate.sigma_estimated_px;
  (*json)["sigma_estimated_sd_px"] = estimate.sigma_estimated_sd_px;
  (*json)["inlier_probabilities"] = estimate.inlier_probabilities;
  (*json)["other_modes"] = nlohmann::ordered_json::array();
  for (const MotionMode& mode : estimate.other_modes) {
    (*json)["other_modes"].push_back({{"weight", mode.weight},
                                      {"explained_share", mode.explained_share},
                                      {"R", RowMajor(mode.cam2_from_cam1.R)},
                                      {"t", RowMajor(mode.cam2_from_cam1.t)},
                                      {"pose_cov", RowMajor(mode.pose_cov)}});
  }
}

nlohmann::ordered_json AsJson(const MotionEstimate& estimate, const TrialRecord& record,
                              const std::string& estimator, bool has_truth_sd) {
  nlohmann::ordered_json json = {{"status", StatusName(estimate.status)},
                                 {"message", estimate.message},
                                 {"estimator", estimator},
                                 {"R", nullptr},
                                 {"t", nullptr},
                                 {"pose_cov", nullptr},
                                 {"num_matches", record.num_matches},
                                 {"num_inliers", record.num_inliers},
                                 {"failed_by_kappa", nullptr}};
  if (estimate.status == MotionStatus::kDirectionNotObservable) {
    json["R"] = RowMajor(estimate.cam2_from_cam1.R);
    json["rotation_cov"] = RowMajor(estimate.pose_cov.topLeftCorner<3, 3>());
  }
  if (estimate.status != MotionStatus::kOk) return json;
  json["R"] = RowMajor(estimate.cam2_from_cam1.R);
  json["t"] = RowMajor(estimate.cam2_from_cam1.t);
  json["pose_cov"] = RowMajor(estimate.pose_cov);
  json["failed_by_kappa"] = estimate.failed_by_kappa;
  if (!std::isnan(estimate.failure_probability)) AddProbabilities(estimate, &json);
  if (!std::isnan(record.rotation_error_deg)) json["rotation_error_deg"] = record.rotation_error_deg;
  if (!std::isnan(record.direction_error_deg)) json["direction_error_deg"] = record.direction_error_deg;
  if (!std::isnan(record.nees)) {
    json["nees"] = JsonNumber(record.nees);
    json["truth_sd"] = has_truth_sd ? "stated" : "unknown";
  }
  return json;
}

constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

void PrintRotation(const MotionEstimate& estimate) {
  fmt::print("rotation of camera 2 from camera 1 (X2 = R X1 + t; t is not known)\n");
  for (int row = 0; row < 3; ++row) {
    const auto& R = estimate.cam2_from_cam1.R;
    fmt::print("  R {:>12.8f} {:>12.8f} {:>12.8f}\n", R(row, 0), R(row, 1), R(row, 2));
  }
  const Eigen::Vector3d sd_deg =
      kDegreesPerRadian * estimate.pose_cov.topLeftCorner<3, 3>().diagonal().cwiseSqrt();
  fmt::print("standard deviations (deg), if there is no translation: {:.4f} {:.4f} {:.4f}\n", sd_deg(0),
             sd_deg(1), sd_deg(2));
}

// The tests of the motion are off as printed. A person should know what they would have said.
void PrintCaution(const RansacEstimator& estimator, const MotionProblem& problem, std::int64_t seed) {
  RansacOptions tested = estimator.options();
  if (tested.ObservabilityLevelOrDefault() < 1.0 || tested.ChanceLevelOrDefault() < 1.0) return;
  tested.observability_significance_level = tested.chance_significance_level = 0.001;
  RandomStream rng = StreamFor({static_cast<std::uint64_t>(seed), 0, 0, 0}, StreamPurpose::kSampling);
  const MotionEstimate estimate = estimator.With(tested)->Estimate(problem, rng);
  if (estimate.status == MotionStatus::kOk) return;
  fmt::print(
      "caution: {} - {}\n  (--set observability_significance_level=0.001 --set "
      "chance_significance_level=0.001 refuses such an answer)\n",
      StatusName(estimate.status), estimate.message);
}

void PrintForPeople(const MotionEstimate& estimate, const TrialRecord& record, const std::string& estimator,
                    bool has_truth_sd) {
  fmt::print("{}: {} - {}\n", estimator, StatusName(estimate.status), estimate.message);
  if (estimate.status == MotionStatus::kDirectionNotObservable) PrintRotation(estimate);
  if (estimate.status != MotionStatus::kOk) return;
  const RelativePose& pose = estimate.cam2_from_cam1;
  fmt::print("cam2_from_cam1 (X2 = R X1 + t, |t| = 1)\n");
  for (int row = 0; row < 3; ++row) {
    fmt::print("  R {:>12.8f} {:>12.8f} {:>12.8f}   t {:>12.8f}\n", pose.R(row, 0), pose.R(row, 1),
               pose.R(row, 2), pose.t(row));
  }
  const Vector5d sd_deg = kDegreesPerRadian * estimate.pose_cov.diagonal().cwiseSqrt();
  fmt::print("standard deviations (deg): rotation {:.4f} {:.4f} {:.4f}, direction {:.4f} {:.4f}\n", sd_deg(0),
             sd_deg(1), sd_deg(2), sd_deg(3), sd_deg(4));
  fmt::print("inliers: {} of {} matches\n", record.num_inliers, record.num_matches);
  if (estimate.failed_by_kappa)
    fmt::print("the paper's failure flag is set: refinement lost half of the inliers\n");
  if (!std::isnan(record.rotation_error_deg)) {
    fmt::print("against the file's true motion: rotation error {:.4f} deg, direction error {:.4f} deg\n",
               record.rotation_error_deg, record.direction_error_deg);
    fmt::print("normalised error squared (5 degrees of freedom, 95 % below 11.07): {:.2f}; {}\n", record.nees,
               has_truth_sd ? "the true motion's own error (truth_sd) is part of it"
                            : "how good the file's motion is, nobody says (no truth_sd)");
  }
}

void RunEstimate(const EstimateArguments& arguments) {
  const EstimatorSpec spec = ChosenEstimator(arguments.estimator);
  const std::unique_ptr<MotionEstimator> estimator = Make(spec);
  MatchFile file = ReadMatchFile(arguments.matches);
  TrialData data;
  data.problem = {std::move(file.matches), file.camera1, file.camera2, arguments.sigma_px};
  data.truth.cam2_from_cam1_true = file.cam2_from_cam1_true;
  data.truth.sd = file.truth_sd;
  RandomStream rng =
      StreamFor({static_cast<std::uint64_t>(arguments.seed), 0, 0, 0}, StreamPurpose::kSampling);
  const MotionEstimate estimate = Judged(estimator->Estimate(data.problem, rng), data.problem.matches.size());
  const TrialRecord record = Score(estimate, data, 0.0);
  if (arguments.as_json) {
    fmt::print("{}",
               JsonText(kEstimateFormat, AsJson(estimate, record, spec.label, data.truth.sd.has_value())));
  } else {
    PrintForPeople(estimate, record, spec.label, data.truth.sd.has_value());
    const RansacEstimator* const ransac = AsRansac(*estimator);
    if (ransac && estimate.status == MotionStatus::kOk) PrintCaution(*ransac, data.problem, arguments.seed);
  }
  // A refusal because of what the file holds is bad input; a refusal by the estimator's own tests is its
  // answer.
  const bool is_bad_input = estimate.status == MotionStatus::kInvalidInput ||
                            estimate.status == MotionStatus::kTooFewMatches ||
                            estimate.status == MotionStatus::kDegenerateMatches;
  if (is_bad_input) throw InputError(fmt::format("{}: {}", arguments.matches, estimate.message));
}

}  // namespace

void AddEstimateCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("estimate", "Estimate the motion between two images from a file of matches");
  command->footer(
      "Without a word about the estimator it is rcme_calibrated, which says how likely it is to be wrong; "
      "the\n"
      "paper's is --estimator rcme. An estimator file (YAML)\n"
      "holds a name, a label and options, so that an estimator that was tuned by simulation runs on a real\n"
      "pair with the very options that were validated; the answer goes by its label. It may be as short as\n"
      "  name: rcme\n"
      "  label: rcme_tuned\n"
      "  options: {reading: rank_aware, mu: 5.25, lambda: 0.6}\n"
      "and the same file serves `rcme run STUDY --add-estimator tuned.yaml`.\n"
      "\n"
      "Examples:\n"
      "  rcme estimate matches.csv.gz --sigma 0.7 --json\n"
      "  rcme estimate matches.csv.gz --estimator standard --set num_iterations=1000\n"
      "  rcme estimate matches.csv.gz --estimator-file tuned.yaml\n"
      "  rcme estimate matches.csv.gz --estimator-file tuned.yaml --set mu=6      the file's options but mu");
  auto arguments = std::make_shared<EstimateArguments>();
  command
      ->add_option("matches", arguments->matches,
                   "match file, plain or gzip: header '# size1: w h', '# K1_fx_fy_cx_cy: ...' (and 2), rows "
                   "x1,y1,x2,y2")
      ->required();
  CLI::Option* estimator =
      command->add_option("--estimator", arguments->estimator.name, "see `rcme list estimators`")
          ->capture_default_str();
  AddEstimatorOptions(command, estimator, &arguments->estimator);
  command->add_option("--sigma", arguments->sigma_px, "noise standard deviation per coordinate, px")
      ->transform(NumberIn({1e-9, 1000.0}))
      ->capture_default_str();
  command->add_option("--seed", arguments->seed, "seed of the random samples")
      ->transform(WholeNumberIn(0))
      ->capture_default_str();
  command->add_flag("--json", arguments->as_json,
                    "one JSON object; R row-major (9), pose_cov row-major (25), rad^2; without a direction "
                    "(direction_not_observable) R and rotation_cov (9) alone");
  command->callback([arguments] { RunEstimate(*arguments); });
}

}  // namespace rcme
