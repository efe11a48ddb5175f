#include "experiments/summarize.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <optional>

#include "parameters/input_error.h"
#include "stats/distributions.h"
#include "stats/moments.h"

namespace rcme {
namespace {

// What a trial contributes to a quantity: nothing (it is not of those the quantity is about), or a number (a
// rate: 0 or 1).
using Contribution = std::function<std::optional<double>(const TrialRecord&, const FailureBounds&)>;

struct Quantity {
  std::string name;
  SummaryRow::Kind kind;
  std::string doc;
  Contribution contribution;
};

std::optional<double> If(bool is_of_interest, double value) {
  return is_of_interest && !std::isnan(value) ? std::optional<double>(value) : std::nullopt;
}

std::optional<double> Yes(bool value) { return value ? 1.0 : 0.0; }

bool IsOk(const TrialRecord& r) { return r.status == MotionStatus::kOk; }

Quantity StatusRate(MotionStatus status, const std::string& doc) {
  return {StatusName(status), SummaryRow::Kind::kRate, doc + ", of all trials",
          [status](const TrialRecord& r, const FailureBounds&) { return Yes(r.status == status); }};
}

const std::vector<Quantity>& Quantities() {
  constexpr auto kRate = SummaryRow::Kind::kRate;
  constexpr auto kMean = SummaryRow::Kind::kMean;
  using R = const TrialRecord&;
  using B = const FailureBounds&;
  static const double nees_bound = ChiSquareQuantile(5, 0.95);
  static const std::vector<Quantity> all = {
      {"success", kRate, "a motion within the failure bounds, of all trials",
       [](R r, B b) { return Yes(HasSucceeded(r, b)); }},
      {"failure", kRate, "a motion beyond a failure bound, of all trials",
       [](R r, B b) { return Yes(HasFailed(r, b)); }},
      StatusRate(MotionStatus::kNoCandidate, "no candidate, the paper's detect-fail"),
      {"other_refusal", kRate, "no motion for any other reason (the sum of the next four), of all trials",
       [](R r, B) { return Yes(!IsOk(r) && r.status != MotionStatus::kNoCandidate); }},
      StatusRate(MotionStatus::kTooFewMatches, "too few distinct matches"),
      StatusRate(MotionStatus::kDegenerateMatches, "matches that determine no motion"),
      StatusRate(MotionStatus::kRefinementDiverged, "refinement without a finite optimum"),
      StatusRate(MotionStatus::kInvalidInput, "numbers that are none"),
      {"kappa_flag", kRate, "the paper's failure flag n*_I / n_I <= kappa, of returned motions",
       [](R r, B) { return If(IsOk(r), r.failed_by_kappa); }},
      {"nees_coverage", kRate, "truth within the 95 % region of the reported covariance, of returned motions",
       [](R r, B) { return If(IsOk(r) && !std::isnan(r.nees), r.nees <= nees_bound); }},
      {"nees", kMean, "normalised estimation error squared (5 expected), of successes",
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
      {"num_candidates", kMean, "hypotheses that passed every test, of all trials",
       [](R r, B) { return std::optional<double>(r.counts.num_candidates); }},
      {"time_ms", kMean, "wall time of the call, of all trials; only with --times",
       [](R r, B) { return std::optional<double>(1e3 * r.seconds); }},
  };
  return all;
}

// The quantities of one estimator in one condition, growing trial by trial.
class Accumulator {
 public:
  Accumulator() : moments_(Quantities().size()) {}

  void Add(const TrialRecord& record, const FailureBounds& bounds) {
    for (size_t q = 0; q < moments_.size(); ++q) {
      const std::optional<double> value = Quantities()[q].contribution(record, bounds);
      if (value) moments_[q].Add(*value);
    }
  }

  SummaryRow Row(size_t q) const {
    SummaryRow row;
    row.quantity = Quantities()[q].name;
    row.kind = Quantities()[q].kind;
    row.value = moments_[q].mean();
    row.n = moments_[q].n();
    if (row.kind == SummaryRow::Kind::kRate) {
      const double successes = row.n > 0 ? row.value * static_cast<double>(row.n) : 0.0;
      row.interval = ExactBinomialInterval(std::llround(successes), row.n);
      if (row.n > 0) row.value = std::round(successes) / static_cast<double>(row.n);
    } else {
      row.standard_error = moments_[q].standard_error();
    }
    return row;
  }

 private:
  std::vector<Moments> moments_;
};

}  // namespace

const std::vector<QuantityHelp>& SummaryQuantities() {
  static const std::vector<QuantityHelp> help = [] {
    std::vector<QuantityHelp> rows;
    for (const Quantity& q : Quantities()) {
      rows.push_back({q.name, q.kind == SummaryRow::Kind::kRate ? "rate" : "mean", q.doc});
    }
    return rows;
  }();
  return help;
}

Summary Summarize(const ResultStore& store, bool with_times) {
  const StudyPlan plan = store.Plan();
  Summary summary{plan.study.name, plan.factor_names, {}, 0, plan.NumTrials()};
  const size_t num_estimators = plan.study.estimators.size();
  std::vector<std::vector<Accumulator>> cells(plan.conditions.size(),
                                              std::vector<Accumulator>(num_estimators));
  store.ForEachRecord([&](const TrialRecord& record) {
    if (record.condition >= cells.size() || record.estimator >= num_estimators) {
      throw InputError(fmt::format("the result file is damaged: no condition {} or estimator {} in its study",
                                   record.condition, record.estimator));
    }
    if (record.estimator == 0) ++summary.num_trials_done;
    cells.at(record.condition).at(record.estimator).Add(record, plan.study.failure);
  });
  for (const Condition& condition : plan.conditions) {
    for (size_t e = 0; e < num_estimators; ++e) {
      for (size_t q = 0; q < Quantities().size(); ++q) {
        SummaryRow row = cells[condition.index][e].Row(q);
        if (row.quantity == "time_ms" && !with_times) continue;
        row.condition = condition.index;
        row.levels = condition.levels;
        row.estimator = plan.study.estimators[e].label;
        summary.rows.push_back(std::move(row));
      }
    }
  }
  return summary;
}

}  // namespace rcme
