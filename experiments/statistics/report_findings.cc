#include "experiments/statistics/report_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "experiments/statistics/quantity_table.h"
#include "peers/outside_answer.h"

namespace rcme {
namespace {

constexpr double kSignificanceLevel = 0.05;
constexpr double kStatedCoverage = 0.95;
constexpr double kLeastCoverage = 0.9, kMostCoverage = 0.98;  // beyond these, a 95 % region is far off
constexpr std::int64_t kFewestAnswers = 10;                   // a coverage of fewer is no finding
constexpr double kManyRefusals = 0.1;                         // a greater rate of refusals is a finding
constexpr size_t kMostFindings = 8;

// Returns the labels in the order of their first row.
template <typename Row>
std::vector<std::string> LabelsIn(const std::vector<Row>& rows) {
  std::vector<std::string> labels;
  for (const Row& row : rows) {
    if (std::find(labels.begin(), labels.end(), row.estimator) == labels.end())
      labels.push_back(row.estimator);
  }
  return labels;
}

// Formats "12.30 % [10.10, 14.80]" with the digits of the tables.
std::string PercentWithInterval(double value, const Interval& interval) {
  return fmt::format("{:.2f} % [{:.2f}, {:.2f}]", 100.0 * value, 100.0 * interval.lower,
                     100.0 * interval.upper);
}

// Formats " at outlier_ratio 0.4, sigma_px 1"; empty without factors.
std::string FormatPlace(const std::vector<std::string>& levels,
                        const std::vector<std::string>& factor_names) {
  std::vector<std::string> words;
  for (size_t f = 0; f < levels.size(); ++f) words.push_back(factor_names[f] + " " + levels[f]);
  return words.empty() ? "" : fmt::format(" at {}", fmt::join(words, ", "));
}

std::string RateAt(const Summary& summary, const SummaryRow& row) {
  return PercentWithInterval(row.value, row.interval) +
         FormatPlace(summary.levels.at(row.condition), summary.factor_names);
}

// Formats " over the population of study any_room"; empty if the numbers are not of a population.
std::string FormatOverPopulation(const Summary& summary) {
  return summary.is_of_population ? " over the population of study " + summary.study : "";
}

// Returns the distance of an interval from a range; 0 if they overlap.
double DistanceFrom(const Interval& interval, double lower, double upper) {
  return std::max({0.0, lower - interval.upper, interval.lower - upper});
}

// A sentence and its importance.
struct Finding {
  double weight = 0.0;
  std::string sentence;
};

void AddByWeight(std::vector<Finding> findings, std::vector<std::string>* sentences) {
  std::ranges::stable_sort(findings, std::greater(), &Finding::weight);
  for (Finding& finding : findings) sentences->push_back(std::move(finding.sentence));
}

// Describes the sharpness of the regions of a coverage, if it is known.
std::string DescribeSharpness(const Summary& summary, const SummaryRow& coverage) {
  std::string words;
  for (const std::string& quantity : AddSharpness(summary, {"nees_coverage"})) {
    for (const SummaryRow& row : summary.rows) {
      if (row.quantity != quantity || row.estimator != coverage.estimator ||
          row.condition != coverage.condition || row.n == 0)
        continue;
      if (quantity == "sd_over_crb")
        words += fmt::format(", with an sd of {:.3g} times the Cramer-Rao bound", row.value);
      else if (quantity != "nees_coverage")
        words += fmt::format(", with {} {:.3g}", quantity, row.value);
    }
  }
  return words;
}

// "that NAME states".
std::string DescribeSource(const Summary& summary, const std::string& label) {
  if (std::ranges::count(summary.outside, label) == 0) return fmt::format("that {} states", label);
  return fmt::format("of {} (where an answer states none, of a {})", label, kCovarianceOfRcme);
}

// Regions that are far from what they state, the farthest first: the worst condition of each estimator.
void AddWrongCoverages(const Summary& summary, std::vector<std::string>* sentences) {
  std::vector<Finding> findings;
  for (const std::string& label : LabelsIn(summary.rows)) {
    const SummaryRow* worst = nullptr;
    double farthest = 0.0;
    int num_off = 0, num_known = 0;
    for (const SummaryRow& row : summary.rows) {
      if (row.estimator != label || row.quantity != "nees_coverage" || row.n < kFewestAnswers) continue;
      ++num_known;
      const double distance = DistanceFrom(row.interval, kLeastCoverage, kMostCoverage);
      if (distance > 0.0) ++num_off;
      if (distance > farthest) worst = &row, farthest = distance;
    }
    if (!worst) continue;
    findings.push_back(
        {farthest,
         fmt::format(
             "Coverage: the 95 % regions {} contain the truth in {}{}{}: they are too {}{}.",
             DescribeSource(summary, label), RateAt(summary, *worst), FormatOverPopulation(summary),
             DescribeSharpness(summary, *worst), worst->value < kStatedCoverage ? "small" : "large",
             num_known > 1 ? fmt::format(", and far off in {} of {} conditions", num_off, num_known) : "")});
  }
  AddByWeight(std::move(findings), sentences);
}

// Stated probabilities that differ from the failure rate, the farthest first.
void AddWrongProbabilities(const std::vector<ForecastMeasures>& forecasts,
                           std::vector<std::string>* sentences) {
  std::vector<Finding> findings;
  for (const ForecastMeasures& f : forecasts) {
    const Interval failure = f.failure.interval;
    const double distance = std::max(failure.lower - f.mean_probability, f.mean_probability - failure.upper);
    if (f.source != ForecastSource::kStated || f.n == 0 || !(distance > 0.0)) continue;
    const std::string of_sure =
        f.num_sure > 0 ? fmt::format("; of the answers with P at most {} {} failed", kSureBelow,
                                     PercentWithInterval(double(f.num_sure_failed) / double(f.num_sure),
                                                         f.sure_failed_interval))
                       : "";
    findings.push_back(
        {distance,
         fmt::format("Probability: {} states a probability of failure of {:.2f} % on "
                     "average, and {} of its answers failed: it is too {}{}.",
                     f.estimator, 100.0 * f.mean_probability, PercentWithInterval(f.failure.value, failure),
                     f.mean_probability < f.failure.value ? "sure" : "careful", of_sure)});
  }
  AddByWeight(std::move(findings), sentences);
}

// Estimators that refuse often, each with the condition with most refusals.
void AddRefusals(const Summary& summary, std::vector<std::string>* sentences) {
  std::vector<Finding> findings;
  for (const std::string& label : LabelsIn(summary.rows)) {
    const SummaryRow* most = nullptr;
    for (const SummaryRow& row : summary.rows) {
      const bool is_refusal = row.quantity == "no_candidate" || row.quantity == "other_refusal";
      if (row.estimator != label || !is_refusal || row.n == 0) continue;
      if (!most || row.value > most->value) most = &row;
    }
    if (!most || most->interval.lower < kManyRefusals) continue;
    findings.push_back(
        {most->value,
         fmt::format("Refusals: {} refuses {}{}{} ({}).", label, summary.is_of_population ? "" : "up to ",
                     RateAt(summary, *most), FormatOverPopulation(summary), most->quantity.text())});
  }
  AddByWeight(std::move(findings), sentences);
}

void AddRangesOfFailure(const Summary& summary, std::vector<std::string>* sentences) {
  for (const std::string& label : LabelsIn(summary.rows)) {
    const SummaryRow *least = nullptr, *most = nullptr;
    for (const SummaryRow& row : summary.rows) {
      if (row.estimator != label || row.quantity != "failure" || row.n == 0) continue;
      if (!least || row.value < least->value) least = &row;
      if (!most || row.value > most->value) most = &row;
    }
    if (!least) continue;
    const std::string range =
        least->value == most->value
            ? PercentWithInterval(least->value, least->interval) +
                  (summary.is_of_population ? FormatOverPopulation(summary) : " throughout")
            : fmt::format("from {} to {}", RateAt(summary, *least), RateAt(summary, *most));
    sentences->push_back(fmt::format("Failure rate of {}: {}.", label, range));
  }
}

// The decisions of the tests of one estimator and event over the conditions.
struct Tally {
  int more = 0, less = 0;
  const ComparisonRow* farthest = nullptr;
};

Tally CountDifferences(const Comparison& comparison, const std::string& label, const std::string& event) {
  Tally tally;
  for (const ComparisonRow& row : comparison.rows) {
    const bool is_decided =
        row.estimator == label && row.event == event && row.holm_p_value < kSignificanceLevel;
    if (!is_decided) continue;
    ++(row.difference > 0.0 ? tally.more : tally.less);
    if (!tally.farthest || std::abs(row.difference) > std::abs(tally.farthest->difference))
      tally.farthest = &row;
  }
  return tally;
}

// Formats "fails less often in 3 (-25.00 points [-30.00, -20.00] at outlier_ratio 0.4) and more often in 1";
// empty if nothing is decided.
std::string DescribeTally(const Tally& tally, const std::string& verb, const Comparison& comparison) {
  std::vector<std::string> parts;
  for (const bool is_less : {true, false}) {
    const int count = is_less ? tally.less : tally.more;
    if (count == 0) continue;
    const bool has_farthest = (tally.farthest->difference < 0.0) == is_less;
    const ComparisonRow& row = *tally.farthest;
    const std::string farthest =
        has_farthest ? fmt::format(" (by {:+.2f} points [{:+.2f}, {:+.2f}]{})", 100.0 * row.difference,
                                   100.0 * row.interval.lower, 100.0 * row.interval.upper,
                                   FormatPlace(row.levels, comparison.factor_names))
                     : "";
    parts.push_back(fmt::format("{} often in {}{}", is_less ? "less" : "more", count, farthest));
  }
  return parts.empty() ? "" : fmt::format("{} {}", verb, fmt::join(parts, " and "));
}

// Estimators ahead of the reference come first; those without a decision share one sentence.
void AddPairedDifferences(const Summary& summary, const Comparison& comparison,
                          std::vector<std::string>* sentences) {
  if (comparison.rows.empty()) return;
  const size_t num_conditions = summary.rows.empty() ? 0 : summary.rows.back().condition + size_t{1};
  const std::string test = fmt::format(
      "of the {} condition{} ({}, Holm-adjusted p < {})", num_conditions, num_conditions == 1 ? "" : "s",
      comparison.rows.front().is_anytime_valid ? "a test that is valid at every look" : "McNemar's test",
      kSignificanceLevel);
  std::vector<Finding> findings;
  std::vector<std::string> undecided;
  for (const std::string& label : LabelsIn(comparison.rows)) {
    const Tally failure = CountDifferences(comparison, label, "failure");
    const Tally refusal = CountDifferences(comparison, label, "refusal");
    std::vector<std::string> parts;
    for (const std::string& part :
         {DescribeTally(failure, "fails", comparison), DescribeTally(refusal, "refuses", comparison)}) {
      if (!part.empty()) parts.push_back(part);
    }
    if (parts.empty()) {
      undecided.push_back(label);
    } else {
      findings.push_back({double(failure.less - failure.more) + 0.01 * (refusal.less - refusal.more),
                          fmt::format("Against {} on the same trials {} {} {}.", comparison.reference, label,
                                      fmt::join(parts, ", "), test)});
    }
  }
  AddByWeight(std::move(findings), sentences);
  if (!undecided.empty()) {
    sentences->push_back(
        fmt::format("Against {} no difference in failures or refusals is decided of {} in any {}.",
                    comparison.reference, fmt::join(undecided, ", "), test));
  }
}

// The farthest ahead of the reference comes first.
void AddDifferencesInPopulation(const Summary& summary, const Comparison& comparison,
                                std::vector<std::string>* sentences) {
  std::vector<Finding> findings;
  for (const ComparisonRow& row : comparison.rows) {
    if (row.event != "failure_or_refusal" || row.n == 0) continue;
    const bool is_decided = row.holm_p_value < kSignificanceLevel;
    findings.push_back(
        {-row.difference,
         fmt::format(
             "Over the population of study {} {} fails or refuses {:+.2f} points [{:+.2f}, {:+.2f}] against {} "
             "on the same trials{}.",
             summary.study, row.estimator, 100.0 * row.difference, 100.0 * row.interval.lower,
             100.0 * row.interval.upper, comparison.reference,
             is_decided ? fmt::format(" (Holm-adjusted p < {})", kSignificanceLevel) : "")});
  }
  AddByWeight(std::move(findings), sentences);
}

// At most kMostFindings: the first of each kind, then the second of each, and so on, in the order of the
// kinds.
std::vector<std::string> KeepFirst(const std::vector<std::vector<std::string>>& kinds) {
  std::vector<size_t> num_kept(kinds.size(), 0);
  size_t num_all = 0, num_left = kMostFindings;
  for (const std::vector<std::string>& kind : kinds) num_all += kind.size();
  for (size_t rank = 0; rank < num_all; ++rank) {
    for (size_t k = 0; k < kinds.size(); ++k) {
      if (rank >= kinds[k].size() || num_left == 0) continue;
      ++num_kept[k];
      --num_left;
    }
  }
  std::vector<std::string> sentences;
  for (size_t k = 0; k < kinds.size(); ++k) {
    sentences.insert(sentences.end(), kinds[k].begin(),
                     kinds[k].begin() + static_cast<std::ptrdiff_t>(num_kept[k]));
  }
  if (num_all > sentences.size())
    sentences.push_back(fmt::format("And {} more in the tables.", num_all - sentences.size()));
  return sentences;
}

}  // namespace

std::vector<std::string> ListFindings(const Summary& summary, const Comparison& comparison,
                                      const std::vector<ForecastMeasures>& forecasts) {
  std::vector<std::vector<std::string>> kinds(5);
  AddWrongCoverages(summary, &kinds[0]);
  if (summary.is_of_population) {
    AddDifferencesInPopulation(summary, comparison, &kinds[1]);
  } else {
    AddPairedDifferences(summary, comparison, &kinds[1]);
  }
  AddWrongProbabilities(forecasts, &kinds[2]);
  AddRefusals(summary, &kinds[3]);
  AddRangesOfFailure(summary, &kinds[4]);
  return KeepFirst(kinds);
}

}  // namespace rcme
