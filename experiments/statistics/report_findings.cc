#include "experiments/statistics/report_findings.h"

#include <fmt/format.h>

#include <algorithm>

namespace rcme {
namespace {

constexpr double kSignificanceLevel = 0.05;

// Labels in the order of their first row.
template <typename Row>
std::vector<std::string> LabelsIn(const std::vector<Row>& rows) {
  std::vector<std::string> labels;
  for (const Row& row : rows) {
    if (std::find(labels.begin(), labels.end(), row.estimator) == labels.end())
      labels.push_back(row.estimator);
  }
  return labels;
}

// "12.3 % [10.1, 14.8] at outlier_ratio 0.4, sigma_px 1".
std::string RateAt(const SummaryRow& row, const std::vector<std::string>& factor_names) {
  std::vector<std::string> levels;
  for (size_t f = 0; f < row.levels.size(); ++f) levels.push_back(factor_names[f] + " " + row.levels[f]);
  return fmt::format("{:.3g} % [{:.3g}, {:.3g}]{}{}", 100.0 * row.value, 100.0 * row.interval.lower,
                     100.0 * row.interval.upper, levels.empty() ? "" : " at ", fmt::join(levels, ", "));
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
            ? fmt::format("{} {}", RateAt(*least, summary.factor_names),
                          summary.is_of_population ? "over the population" : "throughout")
            : fmt::format("from {} to {}", RateAt(*least, summary.factor_names),
                          RateAt(*most, summary.factor_names));
    sentences->push_back(fmt::format("Failure rate of {}: {}.", label, range));
  }
}

struct Tally {
  int more = 0, less = 0;
};

Tally CountDifferences(const Comparison& comparison, const std::string& label, const std::string& event) {
  Tally tally;
  for (const ComparisonRow& row : comparison.rows) {
    const bool is_decided =
        row.estimator == label && row.event == event && row.holm_p_value < kSignificanceLevel;
    if (is_decided) ++(row.difference > 0.0 ? tally.more : tally.less);
  }
  return tally;
}

void AddPairedDifferences(const Summary& summary, const Comparison& comparison,
                          std::vector<std::string>* sentences) {
  if (comparison.rows.empty()) return;
  const size_t num_conditions = summary.rows.empty() ? 0 : summary.rows.back().condition + size_t{1};
  const std::string test = fmt::format(
      "of the {} condition{} ({}, Holm-adjusted p < {})", num_conditions, num_conditions == 1 ? "" : "s",
      comparison.rows.front().is_anytime_valid ? "a test that is valid at every look" : "McNemar's test",
      kSignificanceLevel);
  for (const std::string& label : LabelsIn(comparison.rows)) {
    const Tally failure = CountDifferences(comparison, label, "failure");
    const Tally refusal = CountDifferences(comparison, label, "refusal");
    sentences->push_back(fmt::format(
        "Against {} on the same trials {} fails less often in {} and more often in {}, refuses less often "
        "in {} and more often in {} {}.",
        comparison.reference, label, failure.less, failure.more, refusal.less, refusal.more, test));
  }
}

// "fails 3.1 points less often [1.2, 5.0]", of the population; nothing without trials.
void AddDifferencesInPopulation(const Comparison& comparison, std::vector<std::string>* sentences) {
  for (const ComparisonRow& row : comparison.rows) {
    if (row.event != "failure_or_refusal" || row.n == 0) continue;
    const bool is_decided = row.holm_p_value < kSignificanceLevel;
    sentences->push_back(fmt::format(
        "Over the population {} fails or refuses {:+.3g} points [{:+.3g}, {:+.3g}] against {} on the "
        "same trials{}.",
        row.estimator, 100.0 * row.difference, 100.0 * row.interval.lower, 100.0 * row.interval.upper,
        comparison.reference, is_decided ? fmt::format(" (Holm-adjusted p < {})", kSignificanceLevel) : ""));
  }
}

}  // namespace

std::vector<std::string> FindingsOf(const Summary& summary, const Comparison& comparison) {
  std::vector<std::string> sentences;
  AddRangesOfFailure(summary, &sentences);
  if (summary.is_of_population) {
    AddDifferencesInPopulation(comparison, &sentences);
  } else {
    AddPairedDifferences(summary, comparison, &sentences);
  }
  return sentences;
}

}  // namespace rcme
