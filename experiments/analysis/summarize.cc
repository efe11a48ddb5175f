#include "experiments/analysis/summarize.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "experiments/trial/trial_measure.h"
#include "stats/confidence_sequence.h"
#include "stats/distributions.h"
#include "stats/moments.h"
#include "stats/score_mean.h"
#include "stats/stream_median.h"
#include "stats/weighted_rate.h"

namespace rcme {
namespace {

// What a trial contributes to a quantity: nothing (it is not of those the quantity is about), or a number (a
// rate: 0 or 1). `Record` is TrialRecord, for estimators, or ProblemRecord.
template <typename Record>
struct Quantity {
  std::string name;
  SummaryRow::Kind kind;
  std::string doc;
  std::function<std::optional<double>(const Record&, const FailureBounds&)> contribution;
};
using TrialQuantity = Quantity<TrialRecord>;
using ProblemQuantity = Quantity<ProblemRecord>;

std::optional<double> If(bool is_of_interest, double value) {
  return is_of_interest && !std::isnan(value) ? std::optional<double>(value) : std::nullopt;
}

std::optional<double> Yes(bool value) { return value ? 1.0 : 0.0; }

bool IsOk(const TrialRecord& r) { return r.status == MotionStatus::kOk; }

TrialQuantity StatusRate(MotionStatus status, const std::string& doc) {
  return {StatusName(status), SummaryRow::Kind::kRate, doc + ", of all trials",
          [status](const TrialRecord& r, const FailureBounds&) { return Yes(r.status == status); }};
}

TrialQuantity QuantityOf(const TrialMeasure& measure, SummaryRow::Kind kind) {
  return {measure.name, kind, measure.doc,
          [measure](const TrialRecord& r, const FailureBounds&) { return measure.Of(r); }};
}

const std::vector<TrialQuantity>& OwnQuantities() {
  constexpr auto kRate = SummaryRow::Kind::kRate;
  constexpr auto kMean = SummaryRow::Kind::kMean;
  constexpr auto kMedian = SummaryRow::Kind::kMedian;
  using R = const TrialRecord&;
  using B = const FailureBounds&;
  static const double nees_bound = ChiSquareQuantile(5, 0.95);
  static const std::vector<TrialQuantity> all = {
      {"not_scored", kRate, "a motion whose truth is not known, of all trials",
       [](R r, B) { return Yes(!IsScored(r)); }},
      {"success", kRate, "a motion within the failure bounds, of all trials but those not scored",
       [](R r, B b) { return If(IsScored(r), HasSucceeded(r, b)); }},
      {"failure", kRate,
       "a motion beyond a failure bound or an answer that is not valid, of all trials but those not scored",
       [](R r, B b) { return If(IsScored(r), HasFailed(r, b)); }},
      StatusRate(MotionStatus::kNoCandidate, "no candidate, the paper's detect-fail"),
      {"other_refusal", kRate, "no motion for any other reason (the sum of the next eight), of all trials",
       [](R r, B) { return Yes(HasRefused(r) && r.status != MotionStatus::kNoCandidate); }},
      StatusRate(MotionStatus::kTooFewMatches, "too few distinct matches"),
      StatusRate(MotionStatus::kDegenerateMatches, "matches that determine no motion"),
      StatusRate(MotionStatus::kRefinementDiverged, "refinement without a finite optimum"),
      StatusRate(MotionStatus::kTooFewExplained, "a refined motion that explains too few matches"),
      StatusRate(MotionStatus::kDirectionNotObservable, "parallax within its noise, no direction"),
      StatusRate(MotionStatus::kNotBetterThanChance, "no more matches agree than by chance"),
      StatusRate(MotionStatus::kInvalidInput, "coordinates, cameras or a noise level that are not valid"),
      StatusRate(MotionStatus::kLibraryError, "another library that the estimator calls failed"),
      StatusRate(MotionStatus::kInvalidMotion, "a failure: not a rotation and a unit vector, or not finite"),
      StatusRate(MotionStatus::kInvalidCovariance, "a failure: not finite, symmetric, positive semidefinite"),
      {"kappa_flag", kRate, "the paper's failure flag n*_I / n_I <= kappa, of returned motions",
       [](R r, B) { return If(IsOk(r), r.failed_by_kappa); }},
      {"nees_coverage", kRate,
       "truth within the 95 % region of the reported covariance (an answer that is not valid does not "
       "cover), of returned motions",
       [](R r, B) { return If(!HasRefused(r) && !std::isnan(r.nees), r.nees <= nees_bound); }},
      {"nees_median", kMedian,
       "normalised estimation error squared (4.35 expected; infinite where not valid), of returned motions",
       [](R r, B) { return If(!HasRefused(r), r.nees); }},
      {"nees", kMean, "the same, its mean (below 5 expected: without failures it is truncated), of successes",
       [](R r, B b) { return If(HasSucceeded(r, b), r.nees); }},
      {"rotation_error_deg", kMean, "rotation error, of successes",
       [](R r, B b) { return If(HasSucceeded(r, b), r.rotation_error_deg); }},
      {"direction_error_deg", kMean, "error of the translation direction, of successes",
       [](R r, B b) { return If(HasSucceeded(r, b), r.direction_error_deg); }},
      {"inlier_precision", kMean, "true ones among the final inliers, of returned motions",
       [](R r, B) { return If(IsOk(r), r.inlier_precision); }},
      {"inlier_recall", kMean, "final inliers among the true ones, of returned motions",
       [](R r, B) { return If(IsOk(r), r.inlier_recall); }},
      {"num_support", kMean, "n_j of the selected hypothesis, of returned motions",
       [](R r, B) { return If(IsOk(r), r.num_support); }},
      {"mean_entropy", kMean, "psi_j of the selected hypothesis (nats), of returned motions",
       [](R r, B) { return If(IsOk(r), r.mean_entropy); }},
      {"explained_share", kMean, "matches that agree with the refined motion, of returned motions",
       [](R r, B) { return If(IsOk(r), static_cast<double>(r.num_explained) / r.num_matches); }},
      {"num_candidates", kMean, "hypotheses that passed every test, of all trials",
       [](R r, B) { return std::optional<double>(r.counts.num_candidates); }},
      {"time_ms", kMedian, "wall time of the call, of all trials; only with --times",
       [](R r, B) { return std::optional<double>(1e3 * r.seconds); }},
  };
  return all;
}

const std::vector<TrialQuantity>& TrialQuantities() {
  static const std::vector<TrialQuantity> all = [] {
    std::vector<TrialQuantity> quantities = OwnQuantities();
    for (const TrialMeasure& score : TrialScores())
      quantities.push_back(QuantityOf(score, SummaryRow::Kind::kScore));
    for (const TrialMeasure& error : TrialErrors())
      quantities.push_back(QuantityOf(error, SummaryRow::Kind::kMedian));
    return quantities;
  }();
  return all;
}

// No unbiased estimator has smaller errors than the bound: where that exceeds what counts as failed, the
// problem and not the estimator is to blame.
bool IsImpossible(const ProblemRecord& problem, const FailureBounds& bounds) {
  return problem.severity.crb_rotation_deg > bounds.max_rotation_error_deg ||
         problem.severity.crb_direction_deg > bounds.max_direction_error_deg;
}

const std::vector<ProblemQuantity>& ProblemQuantities() {
  static const std::vector<ProblemQuantity> all = [] {
    std::vector<ProblemQuantity> quantities = {
        {"impossible", SummaryRow::Kind::kRate,
         "Cramer-Rao bound beyond a failure bound, of measured problems",
         [](const ProblemRecord& p, const FailureBounds& b) {
           return If(!std::isnan(p.severity.crb_rotation_deg), IsImpossible(p, b));
         }},
        {"num_inliers_true", SummaryRow::Kind::kMean, "true matches",
         [](const ProblemRecord& p, const FailureBounds&) { return If(true, p.num_inliers_true); }}};
    Severity names;
    VisitSeverity(names, [&](const std::string& name, const double&) {
      quantities.push_back({name, SummaryRow::Kind::kMean, "severity of the problem (simulator/severity)",
                            [name](const ProblemRecord& p, const FailureBounds&) {
                              double value = Severity::kUnknown;
                              VisitSeverity(p.severity, [&](const std::string& other, const double& field) {
                                if (other == name) value = field;
                              });
                              return If(true, value);
                            }});
    });
    return quantities;
  }();
  return all;
}

// The quantities of one estimator, or of the problems, in one condition, growing trial by trial.
template <typename Record>
class Accumulator {
 public:
  explicit Accumulator(const std::vector<Quantity<Record>>& quantities)
      : quantities_(quantities), moments_(quantities.size()) {}

  void Add(const Record& record, double weight, const FailureBounds& bounds) {
    ++num_trials_;
    is_weighted_ = is_weighted_ || weight != 1.0;
    for (size_t q = 0; q < moments_.size(); ++q) {
      const std::optional<double> value = quantities_[q].contribution(record, bounds);
      if (!value) continue;
      moments_[q].Add(*value);
      if (quantities_[q].kind == SummaryRow::Kind::kRate) weighted_[q].Add(weight, *value != 0.0);
      if (quantities_[q].kind == SummaryRow::Kind::kMedian) medians_[q].Add(*value);
      if (quantities_[q].kind == SummaryRow::Kind::kScore) scores_[q].Add(*value);
    }
  }

  // `cell` holds what the rows share.
  void AppendRows(const SummaryRow& cell, std::vector<SummaryRow>* rows) const {
    for (size_t q = 0; q < moments_.size(); ++q) {
      SummaryRow row = cell;
      row.quantity = quantities_[q].name;
      row.kind = quantities_[q].kind;
      row.value = moments_[q].mean();
      row.n = moments_[q].n();
      if (is_weighted_) row.interval_kind = IntervalKind::kWeighted;
      if (row.kind == SummaryRow::Kind::kMedian) {
        FillMedian(is_weighted_ ? StreamMedian() : medians_[q], &row);
      } else if (is_weighted_) {
        FillWeighted(q, &row);
      } else if (row.kind == SummaryRow::Kind::kRate) {
        FillRate(&row);
      } else if (row.kind == SummaryRow::Kind::kScore) {
        row.interval_kind = IntervalKind::kBetting;
        row.interval = scores_[q].Sequence();
      } else {
        row.standard_error = moments_[q].standard_error();
      }
      rows->push_back(std::move(row));
    }
  }

 private:
  void FillRate(SummaryRow* row) const {
    const std::int64_t successes = row->n > 0 ? std::llround(row->value * static_cast<double>(row->n)) : 0;
    row->interval = row->interval_kind == IntervalKind::kExact ? ExactBinomialInterval(successes, row->n)
                                                               : ConfidenceSequence(successes, row->n);
    if (row->n == 0) return;
    row->value = static_cast<double>(successes) / static_cast<double>(row->n);
    if (row->quantity != "nees_coverage") return;
    const bool is_of_fixed_n = row->interval_kind == IntervalKind::kExact;
    row->coverage_verdict = JudgeCoverage(row->value, row->interval, row->n, num_trials_, is_of_fixed_n);
  }

  // Its interval is of a number of trials that was fixed beforehand.
  static void FillMedian(const StreamMedian& median, SummaryRow* row) {
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    row->value = median.median();
    row->n = median.n();
    row->interval = row->interval_kind == IntervalKind::kExact ? median.interval() : Interval{kNaN, kNaN};
  }

  void FillWeighted(size_t q, SummaryRow* row) const {
    const bool is_of_all = row->kind == SummaryRow::Kind::kRate && row->n == num_trials_;
    const WeightedRate rate = EstimateWeightedRate(is_of_all ? weighted_[q] : WeightedEvents());
    row->n = is_of_all ? row->n : 0;
    row->value = is_of_all ? std::min(rate.estimate, 1.0) : std::numeric_limits<double>::quiet_NaN();
    row->standard_error = is_of_all ? rate.standard_error : row->value;
    row->interval = {std::min(rate.interval.lower, 1.0), std::min(rate.cautious_upper, 1.0)};
  }

  const std::vector<Quantity<Record>>& quantities_;
  std::vector<Moments> moments_;
  std::vector<WeightedEvents> weighted_{quantities_.size()};
  std::vector<StreamMedian> medians_{quantities_.size()};
  std::vector<ScoreMean> scores_{quantities_.size()};
  std::int64_t num_trials_ = 0;
  bool is_weighted_ = false;
};

// The accumulators of one condition.
struct Cell {
  std::vector<Accumulator<TrialRecord>> estimators;
  Accumulator<ProblemRecord> problems{ProblemQuantities()};
};

template <typename Record>
void AppendHelp(const std::vector<Quantity<Record>>& quantities, std::vector<QuantityHelp>* rows) {
  for (const Quantity<Record>& q : quantities) {
    rows->push_back({q.name, KindName(q.kind), q.doc});
  }
}

}  // namespace

const std::vector<QuantityHelp>& SummaryQuantities() {
  static const std::vector<QuantityHelp> help = [] {
    std::vector<QuantityHelp> rows;
    AppendHelp(TrialQuantities(), &rows);
    AppendHelp(ProblemQuantities(), &rows);
    return rows;
  }();
  return help;
}

std::string KindName(SummaryRow::Kind kind) {
  switch (kind) {
    case SummaryRow::Kind::kRate:
      return "rate";
    case SummaryRow::Kind::kMean:
      return "mean";
    case SummaryRow::Kind::kMedian:
      return "median";
    case SummaryRow::Kind::kScore:
      return "score";
  }
  return "";
}

Summary Summarize(const ResultStore& store, bool with_times, Pooling pooling) {
  RunDescription run = store.Description();
  const std::int64_t num_planned = run.NumTrials();
  const bool is_pooled = pooling == Pooling::kPooled;
  if (is_pooled) {
    run.factors.clear();
    run.conditions = {{}};
  }
  Summary summary{run.study, run.factors, {}, {}, 0, num_planned};
  for (const DescribedEstimator& estimator : run.estimators)
    summary.efforts.emplace_back(estimator.label, estimator.effort);
  const size_t num_estimators = run.estimators.size();
  const Accumulator<TrialRecord> empty(TrialQuantities());
  std::vector<Cell> cells(run.conditions.size(), Cell{std::vector(num_estimators, empty)});
  store.ForEachTrial([&](const ProblemRecord& problem, const std::vector<TrialRecord>& records) {
    ++summary.num_trials_done;
    Cell& cell = cells[is_pooled ? 0 : problem.condition];
    cell.problems.Add(problem, problem.weight, run.failure);
    for (size_t e = 0; e < num_estimators; ++e)
      cell.estimators[e].Add(records[e], problem.weight, run.failure);
  });
  for (std::uint32_t c = 0; c < run.conditions.size(); ++c) {
    const Cell& cell = cells[c];
    SummaryRow row;
    row.condition = c;
    row.levels = run.conditions[c].levels;
    if (!run.stopping_rule.empty()) row.interval_kind = IntervalKind::kAnytimeValid;
    for (size_t e = 0; e < num_estimators; ++e) {
      row.estimator = run.estimators[e].label;
      cell.estimators[e].AppendRows(row, &summary.rows);
    }
    row.estimator = kSceneLabel;
    cell.problems.AppendRows(row, &summary.rows);
  }
  if (!with_times)
    std::erase_if(summary.rows, [](const SummaryRow& row) { return row.quantity == "time_ms"; });
  return summary;
}

}  // namespace rcme
