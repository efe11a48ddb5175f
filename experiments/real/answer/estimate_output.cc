#include "experiments/real/answer/estimate_output.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "estimator/conform/conform_estimator.h"
#include "estimator/conform/conform_file.h"
#include "experiments/core/text/columns.h"
#include "experiments/core/text/field_text.h"
#include "experiments/real/answer/motion_words.h"
#include "experiments/real/answer/refusal_advice.h"
#include "experiments/study/estimator_spec.h"
#include "parameters/probability_text.h"
#include "parameters/settings.h"
#include "peers/outside_answer.h"
#include "stats/constants.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

// Returns the numbers of a matrix, row by row.
std::vector<double> RowMajor(const Eigen::MatrixXd& matrix) {
  std::vector<double> numbers;
  for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
    for (Eigen::Index c = 0; c < matrix.cols(); ++c) numbers.push_back(matrix(r, c));
  }
  return numbers;
}

std::string Vector(const Eigen::Vector3d& v) {
  return fmt::format("({:.3f}, {:.3f}, {:.3f})", v.x(), v.y(), v.z());
}

std::string Percent(double share) { return std::isnan(share) ? "?" : fmt::format("{:.0f} %", 100.0 * share); }

std::string RotationText(const Eigen::Matrix3d& R) {
  std::string text;
  for (int row = 0; row < 3; ++row)
    text += fmt::format("  R {:>12.8f} {:>12.8f} {:>12.8f}\n", R(row, 0), R(row, 1), R(row, 2));
  return text;
}

// Without a direction there is only a rotation.
std::string RotationAloneText(const MotionEstimate& estimate) {
  const Eigen::Vector3d sd_deg = kDegPerRad * estimate.pose_cov.topLeftCorner<3, 3>().diagonal().cwiseSqrt();
  return fmt::format(
      "rotation of camera 2 from camera 1 (X2 = R X1 + t; t is not known)\n{}standard deviations (deg), if "
      "there is no translation: {:.4f} {:.4f} {:.4f}\n",
      RotationText(estimate.cam2_from_cam1.R), sd_deg(0), sd_deg(1), sd_deg(2));
}

std::string FoundText(const RelativePose& pose, const MotionSpread& spread) {
  const Turn turn = ComputeTurn(pose.R);
  std::string text = "\nFound: how camera 2 stands to camera 1 (x to the right, y down, z forward)\n";
  text += fmt::format("  turned     {:.4g} deg (sd {:.2g})", turn.angle_deg, spread.angle_sd_deg);
  // The axis of an angle within its noise is meaningless.
  if (turn.angle_deg > 3.0 * spread.angle_sd_deg) {
    text += fmt::format(": {}\n             about the axis {} of camera 1", turn.words,
                        Vector(turn.axis_in_cam1));
  }
  text += fmt::format("\n  stands     {}: towards {} from camera 1\n", DescribePlace(pose),
                      Vector(ComputePlace(pose)));
  text += fmt::format("             sd of the direction {:.2g} deg, across {:.2g} deg\n",
                      spread.direction_sd_deg(0), spread.direction_sd_deg(1));
  text += "  cam2_from_cam1, X2 = R X1 + t, |t| = 1\n";
  for (int row = 0; row < 3; ++row) {
    text += fmt::format("  R {:>12.8f} {:>12.8f} {:>12.8f}   t {:>12.8f}\n", pose.R(row, 0), pose.R(row, 1),
                        pose.R(row, 2), pose.t(row));
  }
  return text;
}

// The bounds of a stated probability are options of the estimator, for `conform` a part of its file.
std::string BoundsText(const EstimatorSpec& spec) {
  std::optional<std::string> rotation = FindSetting(spec.options, "max_rotation_error_deg");
  std::optional<std::string> direction = FindSetting(spec.options, "max_direction_error_deg");
  if (spec.name == kConformEstimator) {
    const ConformRule rule = ReadConformFile(FindSetting(spec.options, "file").value_or("")).rule;
    rotation = fmt::format("{}", rule.max_rotation_error_deg);
    direction = fmt::format("{}", rule.max_direction_error_deg);
  }
  if (!rotation || !direction) return "beyond the bounds that the estimator was made for";
  return fmt::format("rotation off by more than {} deg or direction by {} deg", *rotation, *direction);
}

std::string ForBoundsText(const std::vector<ProbabilityForBounds>& for_bounds) {
  std::string text;
  for (const ProbabilityForBounds& each : for_bounds) {
    text += fmt::format("             {}  (rotation off by more than {} deg or direction by {} deg){}\n",
                        ProbabilityText(each.failure_probability), each.bounds.max_rotation_error_deg,
                        each.bounds.max_direction_error_deg,
                        each.domain == ProbabilityDomain::kExtrapolated ? ", extrapolated" : "");
  }
  return text;
}

std::string FormatProtection(const LevelsAtRisk& at) {
  return fmt::format(
      "  levels     rotation {:.3g} deg, direction {:.3g} deg: each error exceeds its level with a\n"
      "             probability of at most {:g}\n",
      kDegPerRad * at.levels.rotation_rad, kDegPerRad * at.levels.direction_rad, at.risk);
}

// What errors of the calibration would do that nobody stated.
std::string CalibrationText(const PairAnswer& answer, const EstimatorSpec& spec) {
  const std::vector<CalibrationEffect>& effects = answer.calibration_effects;
  std::string text = effects.empty()
                         ? ""
                         : "  if K is off, errors with these standard deviations move the motion by (rms)\n";
  for (const CalibrationEffect& effect : effects) {
    text += fmt::format("             {:<27} rotation {:.2g} deg, direction {:.2g} deg\n", effect.error,
                        effect.rotation_rms_deg, effect.direction_rms_deg);
  }
  if (!effects.empty())
    text += fmt::format("             state what you know of K by{} --set focal_sd=0.01\n",
                        CanStateCalibrationErrors(spec) ? "" : " --set covariance=robust");
  constexpr double kNotable = 0.05;
  const double probability = answer.estimate.calibration_error_probability;
  if (probability >= kNotable)
    text += fmt::format(
        "  K is off   with probability {}, by its prior and the residuals: the covariance counts\n"
        "             it. Correlated noise looks the same\n",
        ProbabilityText(probability));
  return text;
}

// The covariance covers 95 % of heavy-tailed errors, most of all with few matches, and may then be wider than
// the posterior that P is of. Says by how much, as the two seem to contradict each other.
std::string NarrowedText(const std::optional<PosteriorSummary>& posterior) {
  constexpr double kVisible = 0.95;
  if (!posterior || posterior->narrowed > kVisible) return {};
  std::string text = fmt::format(
      "             This covariance is wider than the distribution that P is computed from: its\n"
      "             standard deviations are {:.2g} times as great.",
      1.0 / posterior->narrowed);
  const auto& [rotation_rad, direction_rad] = posterior->quantile_95;
  if (std::isfinite(rotation_rad + direction_rad))
    text += fmt::format(
        " 95 % of that distribution's rotations\n             are within {:.2g} deg of the answer, 95 % of its "
        "directions within {:.2g} deg.",
        kDegPerRad * rotation_rad, kDegPerRad * direction_rad);
  return text + "\n";
}

std::string SureText(const PairAnswer& answer, const MotionSpread& spread, const EstimatorSpec& spec) {
  const MotionEstimate& estimate = answer.estimate;
  std::string text = "\nHow sure\n";
  if (std::isnan(estimate.failure_probability)) {
    text += "  P(wrong)   not stated by this estimator; rcme_calibrated states it\n";
  } else {
    text += fmt::format("  P(wrong)   {}  ({})\n", ProbabilityText(estimate.failure_probability),
                        BoundsText(spec));
    if (estimate.probability_domain == ProbabilityDomain::kExtrapolated)
      text += "             extrapolated: matches like these were not among those that P was verified on\n";
    text += ForBoundsText(answer.for_bounds);
  }
  text += fmt::format(
      "  95 %       rotation within {:.2g} x {:.2g} x {:.2g} deg, direction within {:.2g} x {:.2g} deg\n",
      spread.rotation_95_deg(0), spread.rotation_95_deg(1), spread.rotation_95_deg(2),
      spread.direction_95_deg(0), spread.direction_95_deg(1));
  text += NarrowedText(answer.posterior);
  if (answer.protection) text += FormatProtection(*answer.protection);
  text += CalibrationText(answer, spec);
  const MotionMode* found = FindRunnerUp(estimate);
  if (found == nullptr) return text;
  const MotionMode& other = *found;
  const RelativePose &a = estimate.cam2_from_cam1, &b = other.cam2_from_cam1;
  text += fmt::format(
      "  otherwise  with probability {:.2g} a motion {:.3g} deg away in rotation,\n             {:.3g} deg "
      "in "
      "direction: {}\n",
      other.weight, kDegPerRad * RotationAngleBetween(a.R, b.R), kDegPerRad * AngleBetween(a.t, b.t),
      DescribePlace(b));
  return text;
}

// Describes what the estimator did with the file's prior.
std::string PriorText(const MotionEstimate& estimate) {
  switch (estimate.prior) {
    case PriorUse::kNone:
      return "  prior      none used: this estimator takes none; rcme_calibrated does\n";
    case PriorUse::kUsed:
      return fmt::format("  prior      used: a right one is as far from the matches with probability {}\n",
                         ProbabilityText(estimate.prior_p_value));
    case PriorUse::kContradicted:
      break;
  }
  return fmt::format(
      "  prior      contradicted: a right one is as far from the matches with probability {};\n"
      "             the answer is of the matches alone\n",
      ProbabilityText(estimate.prior_p_value));
}

std::string EvidenceText(const MotionEvidence& e) {
  std::string text = "\nWhat it rests on\n";
  text += fmt::format("  inliers    {} of {} matches ({})\n", e.num_inliers, e.num_matches,
                      Percent(1.0 * e.num_inliers / std::max(e.num_matches, 1)));
  if (std::isnan(e.sigma_px)) return text + "  too few distinct ones to say more\n";
  text += fmt::format("  noise      {:.2g} px (sd {:.1g}) in their residuals, {:.2g} px assumed\n",
                      e.sigma_px, e.sigma_sd_px, e.sigma_assumed_px);
  text +=
      fmt::format("  parallax   median {:.2g} deg, {:.0f} times its noise; {} show more than a rotation\n",
                  e.parallax_median_deg, e.parallax_to_noise, Percent(e.parallax_share));
  return text + fmt::format("  plane      {} could lie on one plane\n", Percent(e.planar_share));
}

// Warnings to read before the motion is used.
std::string WarningsText(const PairAnswer& answer) {
  const MotionEvidence& e = answer.evidence;
  std::string text;
  if (e.DoesNoiseDisagree()) {
    text += fmt::format("warning: the residuals say {:.2g} px where {:.2g} px was assumed; ", e.sigma_px,
                        e.sigma_assumed_px);
    text +=
        std::isnan(answer.estimate.sigma_estimated_px)
            ? fmt::format("inliers and covariance\n  rest on the assumption: --sigma {:.2g}\n", e.sigma_px)
            : "the covariance goes\n  by the residuals\n";
  }
  if (e.parallax_to_noise < 3.0)
    text += "warning: the parallax hardly exceeds its noise: the direction may be anything\n";
  if (e.planar_share > 0.9 && e.parallax_to_noise >= 3.0)
    text += "warning: nearly all inliers lie on one plane: a second motion explains them as well\n";
  if (answer.estimate.failed_by_kappa)
    text += "the paper's failure flag is set: refinement lost half of the inliers\n";
  return text.empty() ? text : "\n" + text;
}

std::string TruthText(const PairAnswer& answer) {
  const TrialRecord& record = answer.record;
  if (std::isnan(record.rotation_error_deg)) return {};
  return fmt::format(
      "\nAgainst the file's true motion\n  rotation error {:.4f} deg, direction error {:.4f} deg\n"
      "  normalised error squared (5 degrees of freedom, 95 % below 11.07): {:.2f};\n  {}\n",
      record.rotation_error_deg, record.direction_error_deg, record.nees,
      answer.has_truth_sd ? "the true motion's own error (truth_sd) is part of it"
                          : "the file's motion is of unknown accuracy (no truth_sd)");
}

// For estimators that state probabilities; see motion_estimate.h.
void AddProbabilities(const MotionEstimate& estimate, Json* json) {
  (*json)["failure_probability"] = estimate.failure_probability;
  if (estimate.probability_domain != ProbabilityDomain::kNotStated)
    (*json)["failure_probability_domain"] = Name(estimate.probability_domain);
  if (!std::isnan(estimate.calibration_error_probability))
    (*json)["calibration_error_probability"] = estimate.calibration_error_probability;
  (*json)["sigma_estimated_px"] = estimate.sigma_estimated_px;
  (*json)["sigma_estimated_sd_px"] = estimate.sigma_estimated_sd_px;
  (*json)["inlier_probabilities"] = estimate.inlier_probabilities;
  (*json)["other_modes"] = Json::array();
  for (const MotionMode& mode : estimate.other_modes) {
    (*json)["other_modes"].push_back(
        {{"weight", mode.weight},
         {"explained_share", mode.explained_share},
         {"R", RowMajor(mode.cam2_from_cam1.R)},
         {"t", RowMajor(mode.cam2_from_cam1.t)},
         {"pose_cov", RowMajor(CovarianceWithTranslation(mode.pose_cov, mode.cam2_from_cam1.t))}});
  }
}

Json ForBoundsAsJson(const std::vector<ProbabilityForBounds>& for_bounds) {
  Json list = Json::array();
  for (const ProbabilityForBounds& each : for_bounds) {
    list.push_back({{"rotation_deg", each.bounds.max_rotation_error_deg},
                    {"direction_deg", each.bounds.max_direction_error_deg},
                    {"failure_probability", each.failure_probability},
                    {"domain", Name(each.domain)}});
  }
  return list;
}

// An angle is null if the weight of none leaves less than 95 % to motions.
Json PosteriorAsJson(const PosteriorSummary& posterior) {
  return {{"weight_of_none", posterior.weight_of_none},
          {"narrowed", posterior.narrowed},
          {"rotation_95_deg", JsonNumber(kDegPerRad * posterior.quantile_95.rotation_rad)},
          {"direction_95_deg", JsonNumber(kDegPerRad * posterior.quantile_95.direction_rad)},
          {"median_R", RowMajor(posterior.median.R)},
          {"median_t", RowMajor(posterior.median.t)}};
}

Json CalibrationEffectsAsJson(const std::vector<CalibrationEffect>& effects) {
  Json list = Json::array();
  for (const CalibrationEffect& effect : effects) {
    list.push_back({{"option", effect.option},
                    {"sd", effect.sd},
                    {"rotation_rms_deg", effect.rotation_rms_deg},
                    {"direction_rms_deg", effect.direction_rms_deg}});
  }
  return list;
}

Json EvidenceAsJson(const MotionEvidence& e) {
  return {{"sigma_px", JsonNumber(e.sigma_px)},
          {"sigma_sd_px", JsonNumber(e.sigma_sd_px)},
          {"sigma_assumed_px", e.sigma_assumed_px},
          {"noise_disagrees", e.DoesNoiseDisagree()},
          {"parallax_median_deg", JsonNumber(e.parallax_median_deg)},
          {"parallax_to_noise", JsonNumber(e.parallax_to_noise)},
          {"parallax_share", JsonNumber(e.parallax_share)},
          {"planar_share", JsonNumber(e.planar_share)}};
}

}  // namespace

PosteriorSummary SummarizePosterior(const MotionPosterior& posterior) {
  return {posterior.weight_of_none, posterior.narrowed,
          PosteriorDistances(posterior, posterior.answer).FindQuantile(0.95), Median(posterior)};
}

std::string AnswerAsText(const PairAnswer& answer, const EstimatorSpec& spec) {
  const MotionEstimate& estimate = answer.estimate;
  std::string text = fmt::format("{}: {} - {}\n", spec.label, StatusName(estimate.status), estimate.message);
  if (estimate.status != MotionStatus::kOk) {
    if (estimate.status == MotionStatus::kDirectionNotObservable) text += RotationAloneText(estimate);
    if (answer.has_prior && estimate.prior != PriorUse::kNone) text += PriorText(estimate);
    text += "what to try\n";
    for (const std::string& sentence : AdviceFor(estimate, spec)) text += "  " + sentence + "\n";
    return text;
  }
  const MotionSpread spread = ComputeSpread(estimate.cam2_from_cam1, estimate.pose_cov);
  return text + FoundText(estimate.cam2_from_cam1, spread) + SureText(answer, spread, spec) +
         EvidenceText(answer.evidence) + (answer.has_prior ? PriorText(estimate) : "") + TruthText(answer) +
         WarningsText(answer);
}

Json AnswerAsJson(const PairAnswer& answer, const EstimatorSpec& spec) {
  const MotionEstimate& estimate = answer.estimate;
  const TrialRecord& record = answer.record;
  Json json = {{"status", StatusName(estimate.status)},
               {"message", estimate.message},
               {"estimator", spec.label},
               {"R", nullptr},
               {"t", nullptr},
               {"pose_cov", nullptr},
               {"num_matches", record.num_matches},
               {"num_inliers", record.num_inliers},
               {"failed_by_kappa", nullptr}};
  if (answer.num_left_out > 0) json["num_left_out"] = answer.num_left_out;
  if (answer.has_prior) {
    json["prior"] = Name(estimate.prior);
    json["prior_p_value"] = JsonNumber(estimate.prior_p_value);
  }
  if (estimate.status == MotionStatus::kDirectionNotObservable) {
    json["R"] = RowMajor(estimate.cam2_from_cam1.R);
    json["rotation_cov"] = RowMajor(estimate.pose_cov.topLeftCorner<3, 3>());
  }
  if (estimate.status != MotionStatus::kOk) {
    json["what_to_try"] = AdviceFor(estimate, spec);
    return json;
  }
  json["R"] = RowMajor(estimate.cam2_from_cam1.R);
  json["t"] = RowMajor(estimate.cam2_from_cam1.t);
  json["pose_cov"] = RowMajor(CovarianceWithTranslation(estimate.pose_cov, estimate.cam2_from_cam1.t));
  json["failed_by_kappa"] = estimate.failed_by_kappa;
  if (!std::isnan(estimate.failure_probability)) AddProbabilities(estimate, &json);
  if (!answer.for_bounds.empty()) json["failure_probabilities"] = ForBoundsAsJson(answer.for_bounds);
  if (answer.posterior) json["posterior"] = PosteriorAsJson(*answer.posterior);
  if (answer.protection) {
    json["protection_levels"] = {{"risk", answer.protection->risk},
                                 {"rotation_rad", answer.protection->levels.rotation_rad},
                                 {"direction_rad", answer.protection->levels.direction_rad}};
  }
  if (!answer.calibration_effects.empty())
    json["calibration_effects"] = CalibrationEffectsAsJson(answer.calibration_effects);
  json["evidence"] = EvidenceAsJson(answer.evidence);
  if (!std::isnan(record.rotation_error_deg)) json["rotation_error_deg"] = record.rotation_error_deg;
  if (!std::isnan(record.direction_error_deg)) json["direction_error_deg"] = record.direction_error_deg;
  if (!std::isnan(record.nees)) {
    json["nees"] = JsonNumber(record.nees);
    json["truth_sd"] = answer.has_truth_sd ? "stated" : "unknown";
  }
  return json;
}

bool IsExtrapolated(const PairAnswer& answer) {
  return answer.estimate.status == MotionStatus::kOk &&
         answer.estimate.probability_domain == ProbabilityDomain::kExtrapolated;
}

std::vector<std::string> ListAnswerColumns(const AnswerTableColumns& columns) {
  std::vector<std::string> names = {"pair", "inliers", "turned (sd)", "stands (sd)", "P(wrong)"};
  for (const FailureBounds& each : columns.bounds)
    names.push_back(fmt::format("P(>{},{})", each.max_rotation_error_deg, each.max_direction_error_deg));
  if (columns.with_levels) names.push_back("levels");
  if (columns.with_errors) names.push_back("errors");
  names.push_back("status");
  return names;
}

std::vector<std::string> FormatAnswerRow(const std::string& name, const PairAnswer& answer,
                                         const AnswerTableColumns& columns) {
  const MotionEstimate& estimate = answer.estimate;
  const TrialRecord& record = answer.record;
  std::vector<std::string> row(ListAnswerColumns(columns).size(), "-");
  row.front() = name;
  row.back() = StatusName(estimate.status);
  row[1] = fmt::format("{}/{}", record.num_inliers, record.num_matches);
  if (estimate.status != MotionStatus::kOk) return row;
  const RelativePose& pose = estimate.cam2_from_cam1;
  const MotionSpread spread = ComputeSpread(pose, estimate.pose_cov);
  row[2] = fmt::format("{:.2f} ({:.2g})", ComputeTurn(pose.R).angle_deg, spread.angle_sd_deg);
  row[3] = fmt::format("{} ({:.2g})", DescribePlace(pose), spread.direction_sd_deg(0));
  if (!std::isnan(estimate.failure_probability))
    row[4] = ProbabilityText(estimate.failure_probability) + (IsExtrapolated(answer) ? "*" : "");
  for (size_t i = 0; i < answer.for_bounds.size(); ++i)
    row[5 + i] = ProbabilityText(answer.for_bounds[i].failure_probability);
  size_t next = 5 + columns.bounds.size();
  if (columns.with_levels && answer.protection)
    row[next] = fmt::format("{:.3g}/{:.3g}", kDegPerRad * answer.protection->levels.rotation_rad,
                            kDegPerRad * answer.protection->levels.direction_rad);
  next += columns.with_levels;
  if (columns.with_errors && !std::isnan(record.rotation_error_deg))
    row[next] = fmt::format("{:.2g}/{:.2g}", record.rotation_error_deg, record.direction_error_deg);
  return row;
}

std::string AnswerLegend(bool with_errors, std::optional<double> integrity_risk, bool with_extrapolated) {
  std::string text =
      "turned: by how much camera 2 is rotated, deg; stands: where it is, seen from camera 1; (sd): their "
      "standard deviations, deg";
  if (integrity_risk) {
    text += fmt::format(
        "; levels: the errors of rotation/direction exceed them with a probability of at most {:g} each, deg",
        *integrity_risk);
  }
  if (with_errors) text += "; errors: of rotation/direction against the file's true motion, deg";
  if (with_extrapolated) text += "; *: matches like these were not among those that P was verified on";
  return FormatParagraph(text);
}

bool IsBadInput(MotionStatus status) {
  return status == MotionStatus::kInvalidInput || status == MotionStatus::kTooFewMatches ||
         status == MotionStatus::kDegenerateMatches;
}

}  // namespace rcme
