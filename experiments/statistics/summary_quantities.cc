#include "experiments/statistics/summary_quantities.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

#include "experiments/statistics/error_ranking.h"
#include "experiments/statistics/failure_forecasts.h"
#include "experiments/trial/severity_columns.h"
#include "experiments/trial/trial_measure.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

std::optional<double> If(bool is_of_interest, double value) {
  return is_of_interest && !std::isnan(value) ? std::optional<double>(value) : std::nullopt;
}

std::optional<double> Yes(bool value) { return value ? 1.0 : 0.0; }

// Bases: what counts for a quantity.
constexpr const char* kAllTrials = "all trials";
constexpr const char* kScored = "scored trials";
constexpr const char* kReturned = "returned motions";
constexpr const char* kSuccesses = "successes";
constexpr const char* kWithCovariance = "returned motions with a covariance";
constexpr const char* kWithCovarianceAndTruth = "covariances with a known truth";
constexpr const char* kMeasured = "measured problems";

bool IsOk(const TrialRecord& r) { return r.status == MotionStatus::kOk; }

bool IsAvailable(const TrialRecord& r, const FailureBounds& bounds) {
  return r.density.rotation_level_deg <= bounds.max_rotation_error_deg &&
         r.density.direction_level_deg <= bounds.max_direction_error_deg;
}

bool HasKnownLevels(const TrialRecord& r) {
  return IsOk(r) && !std::isnan(r.density.rotation_level_deg) && !std::isnan(r.rotation_error_deg) &&
         !std::isnan(r.direction_error_deg);
}

bool IsMisleading(const TrialRecord& r) {
  return r.rotation_error_deg > r.density.rotation_level_deg ||
         r.direction_error_deg > r.density.direction_level_deg;
}

bool IsSure(const TrialRecord& r) {
  const std::optional<double> stated = StatedFailureProbability(r);
  return stated && *stated <= kSureBelow;
}

TrialQuantity StatusRate(MotionStatus status, const std::string& doc) {
  return {StatusName(status), SummaryRow::Kind::kRate, doc, kAllTrials,
          [status](const TrialRecord& r, const FailureBounds&) { return Yes(r.status == status); }};
}

TrialQuantity MakeQuantity(const TrialMeasure& measure, SummaryRow::Kind kind) {
  return {measure.name, kind, measure.doc, measure.base,
          [measure](const TrialRecord& r, const FailureBounds&) { return measure.Of(r); }};
}

const std::vector<TrialQuantity>& OwnQuantities() {
  constexpr auto kRate = SummaryRow::Kind::kRate;
  constexpr auto kMean = SummaryRow::Kind::kMean;
  constexpr auto kMedian = SummaryRow::Kind::kMedian;
  constexpr auto kScore = SummaryRow::Kind::kScore;
  using R = const TrialRecord&;
  using B = const FailureBounds&;
  static const double nees_bound = ChiSquareQuantile(5, 0.95);
  static const std::vector<TrialQuantity> all = {
      {"not_scored", kRate, "truth unknown or in doubt", kAllTrials,
       [](R r, B) { return Yes(!IsScored(r)); }},
      {"success", kRate, "motion within the failure bounds", kScored,
       [](R r, B b) { return If(IsScored(r), HasSucceeded(r, b)); }},
      {"failure", kRate, "motion beyond a failure bound, or invalid answer", kScored,
       [](R r, B b) { return If(IsScored(r), HasFailed(r, b)); }},
      {"failure_or_refusal", kRate, "failure, or no motion", kScored,
       [](R r, B b) { return If(IsScored(r), HasFailedOrRefused(r, b)); }},
      StatusRate(MotionStatus::kNoCandidate, "the paper's detect-fail"),
      {"other_refusal", kRate, "no motion for any other reason: the sum of the next fifteen", kAllTrials,
       [](R r, B) { return Yes(HasRefused(r) && r.status != MotionStatus::kNoCandidate); }},
      StatusRate(MotionStatus::kTooFewMatches, "too few distinct matches"),
      StatusRate(MotionStatus::kDegenerateMatches, "matches determine no motion"),
      StatusRate(MotionStatus::kRefinementDiverged, "refinement without a finite optimum"),
      StatusRate(MotionStatus::kTooFewExplained, "refined motion explains too few matches"),
      StatusRate(MotionStatus::kDirectionNotObservable, "parallax within its noise"),
      StatusRate(MotionStatus::kNotBetterThanChance, "no more matches agree than by chance"),
      StatusRate(MotionStatus::kTooUncertain, "probability of failure above the allowed one"),
      StatusRate(MotionStatus::kPlanarScene, "model choice: matches on a plane"),
      StatusRate(MotionStatus::kRotationOnly, "model choice: no translation to be seen"),
      StatusRate(MotionStatus::kTooLittleParallax, "model choice: too few matches show parallax"),
      StatusRate(MotionStatus::kInvalidInput, "invalid coordinates, cameras or noise level"),
      StatusRate(MotionStatus::kLibraryError, "a library that the estimator calls failed"),
      StatusRate(MotionStatus::kTimedOut, "outside estimator: no answer in time"),
      StatusRate(MotionStatus::kNoAnswer, "outside estimator: ended without an answer"),
      StatusRate(MotionStatus::kUnreadableAnswer, "outside estimator: malformed answer"),
      StatusRate(MotionStatus::kInvalidMotion, "failure: not a rotation and a unit vector, or not finite"),
      StatusRate(MotionStatus::kInvalidCovariance,
                 "failure: not finite, symmetric and positive semidefinite"),
      StatusRate(MotionStatus::kNotSimulated,
                 "the simulator could not make the draw's trial; no other quantity counts it"),
      {"kappa_flag", kRate, "the paper's failure flag n*_I / n_I <= kappa", kReturned,
       [](R r, B) { return If(IsOk(r), r.failed_by_kappa); }},
      {"nees_coverage", kRate, "truth within the 95 % region of the covariance; not if invalid", kReturned,
       [](R r, B) { return If(!HasRefused(r) && !std::isnan(r.nees), r.nees <= nees_bound); }},
      {"nees_median", kMedian, "normalised estimation error squared; 4.35 expected, infinite if invalid",
       kReturned, [](R r, B) { return If(!HasRefused(r), r.nees); }},
      {"nees", kMean, "the same; below 5 expected, as the bounds truncate it", kSuccesses,
       [](R r, B b) { return If(HasSucceeded(r, b), r.nees); }},
      {"rotation_error_deg", kMean, "rotation error", kSuccesses,
       [](R r, B b) { return If(HasSucceeded(r, b), r.rotation_error_deg); }},
      {"direction_error_deg", kMean, "error of the translation direction", kSuccesses,
       [](R r, B b) { return If(HasSucceeded(r, b), r.direction_error_deg); }},
      {"rotation_sd_deg", kMedian, "root of the trace of the covariance's rotation block", kWithCovariance,
       [](R r, B) { return If(IsOk(r), r.density.rotation_sd_deg); }},
      {"direction_sd_deg", kMedian, "the same for the direction", kWithCovariance,
       [](R r, B) { return If(IsOk(r), r.density.direction_sd_deg); }},
      {"sd_over_crb", kMedian,
       "sharpness: geometric mean of both over their Cramer-Rao bounds; below 1 is too small",
       "returned motions with bounds", [](R r, B) { return If(IsOk(r), r.density.sd_over_crb); }},
      {"log_det_cov", kMean, "ln det of the covariance (5x5, rad)", "returned motions with a density",
       [](R r, B) { return If(IsOk(r), r.density.log_det_cov); }},
      {"energy_score_deg", kMean, "energy score of the stated density, 0 best", kWithCovarianceAndTruth,
       [](R r, B) { return If(IsOk(r), r.density.energy_score_deg); }},
      {"log_score", kMean, "-ln p(error) of the stated density, nats; less is better",
       "the same without singular ones", [](R r, B) { return If(IsOk(r), r.density.log_score); }},
      {"singular_covariance", kRate, "singular covariance, hence no density and no log_score",
       kWithCovariance,
       [](R r, B) { return If(IsOk(r) && r.density.HasCovariance(), r.density.IsSingular()); }},
      {"available", kRate, "both protection levels (risk 0.01) within the failure bounds", kAllTrials,
       [](R r, B b) { return Yes(IsOk(r) && IsAvailable(r, b)); }},
      {"misleading", kRate, "error beyond its protection level; at most 0.02 is right",
       "returned motions with a known truth", [](R r, B) { return If(HasKnownLevels(r), IsMisleading(r)); }},
      {"inlier_precision", kMean, "true ones among the final inliers", kReturned,
       [](R r, B) { return If(IsOk(r), r.inlier_precision); }},
      {"inlier_recall", kMean, "final inliers among the true ones", kReturned,
       [](R r, B) { return If(IsOk(r), r.inlier_recall); }},
      {"num_support", kMean, "n_j of the selected hypothesis", kReturned,
       [](R r, B) { return If(IsOk(r), r.num_support); }},
      {"mean_entropy", kMean, "psi_j of the selected hypothesis, nats", kReturned,
       [](R r, B) { return If(IsOk(r), r.mean_entropy); }},
      {"explained_share", kMean, "matches that agree with the refined motion", kReturned,
       [](R r, B) { return If(IsOk(r), static_cast<double>(r.num_explained) / r.num_matches); }},
      {"num_candidates", kMean, "hypotheses that passed every test", kAllTrials,
       [](R r, B) { return std::optional<double>(r.counts.num_candidates); }},
      {"sigma_estimated_px", kMean, "noise level estimated from the residuals", "returned motions with one",
       [](R r, B) { return If(IsOk(r), r.sigma_estimated_px); }},
      {"inlier_brier", kScore, "mean squared error of the inlier probabilities, 0 best",
       "returned motions with them", [](R r, B) { return If(IsOk(r), r.inlier_brier); }},
      {"failure_probability", kScore, "stated probability of failure P", "answers with P and a known truth",
       [](R r, B) { return StatedFailureProbability(r); }},
      {"brier", kScore, "Brier score (P - y)^2, 0 best", "the same", BrierOfStated},
      {"failure_of_sure", kRate, "failure", "the same with P at most 0.1",
       [](R r, B b) { return If(IsSure(r), HasFailed(r, b)); }},
      {"time_ms", kMedian, "processor time of the call; only with --times", kAllTrials,
       [](R r, B) { return std::optional<double>(1e3 * r.seconds); }},
      {"mean_time_ms", kMean, "the same, set by `rcme budget`; only with --times", kAllTrials,
       [](R r, B) { return std::optional<double>(1e3 * r.seconds); }},
  };
  return all;
}

// Quantities that few estimators state.
bool IsOfProbabilities(const std::string& quantity) {
  return quantity == "sigma_estimated_px" || quantity == "inlier_brier" ||
         quantity == "failure_probability" || quantity == "brier" || quantity == "failure_of_sure";
}

// Quantities that few data or estimators have: bounds, which real pairs lack, and a covariance.
bool IsOfDensity(const std::string& quantity) {
  return quantity == "rotation_sd_deg" || quantity == "direction_sd_deg" || quantity == "sd_over_crb" ||
         quantity == "log_det_cov" || quantity == "energy_score_deg" || quantity == "log_score" ||
         quantity == "singular_covariance" || quantity == "available" || quantity == "misleading" ||
         IsOfErrorRanking(quantity);
}

// Outcomes that only estimators outside the program have.
bool IsOfOutside(const std::string& quantity) {
  return quantity == StatusName(MotionStatus::kTimedOut) || quantity == StatusName(MotionStatus::kNoAnswer) ||
         quantity == StatusName(MotionStatus::kUnreadableAnswer);
}

// Two quantities name trials that do not count; no other quantity includes these trials.
void LeaveOutUncounted(TrialQuantity* quantity) {
  if (quantity->name == StatusName(MotionStatus::kNotSimulated)) return;
  quantity->is_of = quantity->name == "not_scored" ? WasSimulated : IsCounted;
}

// Whether any row of a quantity has trials, and whether any has a value above 0.
struct Presence {
  bool has_numbers = false, has_events = false;
  void Add(const SummaryRow& row) {
    has_numbers = has_numbers || row.n > 0;
    has_events = has_events || row.value > 0.0;
  }
};

// No unbiased estimator has smaller errors than the bound. If the bound exceeds the failure bounds, the
// problem is to blame and not the estimator.
bool IsImpossible(const ProblemRecord& problem, const FailureBounds& bounds) {
  return problem.severity.crb_rotation_deg > bounds.max_rotation_error_deg ||
         problem.severity.crb_direction_deg > bounds.max_direction_error_deg;
}

}  // namespace

const std::vector<TrialQuantity>& TrialQuantities() {
  static const std::vector<TrialQuantity> all = [] {
    std::vector<TrialQuantity> quantities = OwnQuantities();
    for (const TrialMeasure& score : TrialScores())
      quantities.push_back(MakeQuantity(score, SummaryRow::Kind::kScore));
    for (const TrialMeasure& error : TrialErrors())
      quantities.push_back(MakeQuantity(error, SummaryRow::Kind::kMedian));
    for (TrialQuantity& quantity : quantities) LeaveOutUncounted(&quantity);
    return quantities;
  }();
  return all;
}

const std::vector<ProblemQuantity>& ProblemQuantities() {
  static const std::vector<ProblemQuantity> all = [] {
    std::vector<ProblemQuantity> quantities = {
        {"impossible", SummaryRow::Kind::kRate, "Cramer-Rao bound beyond a failure bound", kMeasured,
         [](const ProblemRecord& p, const FailureBounds& b) {
           return If(!std::isnan(p.severity.crb_rotation_deg), IsImpossible(p, b));
         }},
        {"num_inliers_true", SummaryRow::Kind::kMean, "true matches", "simulated problems",
         [](const ProblemRecord& p, const FailureBounds&) { return If(true, p.num_inliers_true); }}};
    for (const SeverityColumn& column : kSeverityColumns) {
      quantities.push_back({column.name, SummaryRow::Kind::kMean, column.meaning, kMeasured,
                            [field = column.field](const ProblemRecord& p, const FailureBounds&) {
                              return If(true, p.severity.*field);
                            }});
    }
    return quantities;
  }();
  return all;
}

bool IsOfTimes(const std::string& quantity) { return quantity == "time_ms" || quantity == "mean_time_ms"; }

void LeaveOutRows(bool with_times, Summary* summary) {
  std::unordered_map<const std::string*, Presence> presence;
  for (const SummaryRow& row : summary->rows) presence[&row.quantity.text()].Add(row);
  const auto has_any = [&](bool (*is_of)(const std::string&), bool Presence::*what) {
    return std::ranges::any_of(presence, [&](const auto& of) { return is_of(*of.first) && of.second.*what; });
  };
  const bool has_probabilities = has_any(IsOfProbabilities, &Presence::has_numbers);
  const bool has_silence = has_any(IsOfOutside, &Presence::has_events);
  std::unordered_set<const std::string*> left_out;
  for (const auto& [name, of_quantity] : presence) {
    const bool is_kept = (has_probabilities || !IsOfProbabilities(*name)) &&
                         (of_quantity.has_numbers || !IsOfDensity(*name)) &&
                         (has_silence || !IsOfOutside(*name)) &&
                         (of_quantity.has_events || *name != StatusName(MotionStatus::kNotSimulated)) &&
                         (with_times || !IsOfTimes(*name));
    if (!is_kept) left_out.insert(name);
  }
  std::erase_if(summary->rows,
                [&](const SummaryRow& row) { return left_out.contains(&row.quantity.text()); });
}

}  // namespace rcme
