#include "experiments/ask/answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "experiments/statistics/compare.h"
#include "experiments/statistics/failure_forecasts.h"
#include "experiments/statistics/quantity_table.h"
#include "experiments/statistics/readable_run.h"
#include "experiments/statistics/summarize.h"
#include "parameters/input_error.h"
#include "parameters/parameter.h"
#include "stats/distributions.h"
#include "stats/equivalence.h"
#include "stats/paired_sample_size.h"

namespace rcme {
namespace {

// MSAC compares the squared Sampson distance with sigma^2 chi2_1 (estimator/point_consistency.h).
InlierThreshold DescribeSampson(double level, double sigma_px) {
  const double num_sigma = std::sqrt(ChiSquareQuantile(1, 1.0 - level)), px = num_sigma * sigma_px;
  return {px, fmt::format("{:.3g} px of Sampson distance ({:.3g} sigma: keeps {:g} % of the true matches)",
                          px, num_sigma, 100.0 * (1.0 - level))};
}

// OpenCV's distance has the standard deviation 2 sigma (peers/opencv_usac.cc).
InlierThreshold DescribeOpenCv(double num_sigma, double sigma_px) {
  const double px = 2.0 * num_sigma * sigma_px;
  return {px, fmt::format("{:.3g} px as OpenCV takes it ({:g} standard deviations of its distance)", px,
                          num_sigma)};
}

// OpenGV's users give 1 - cos(atan(px / f)), the angle at the image's center. The estimator takes the mean
// over the image (peers/opengv_ransac.cc).
InlierThreshold DescribeOpenGv(double num_sigma, double sigma_px, double focal_px) {
  const double px = num_sigma * sigma_px;
  return {px,
          fmt::format("{:.3g} px of reprojection error in both images together ({:g} sigma); as OpenGV takes "
                      "it, 1 - cos(atan({:.3g} / {:g})) = {:.3g}",
                      px, num_sigma, px, focal_px, 1.0 - std::cos(std::atan(px / focal_px)))};
}

// RCME's test widens with the uncertainty of each hypothesis.
std::string DescribeTestOfHypothesis(double level, double sigma_px) {
  return fmt::format(
      "none in px: a test that keeps {:g} % of the true matches, given sigma = {:g} px and each hypothesis' "
      "covariance",
      100.0 * (1.0 - level), sigma_px);
}

std::string DescribeCalibrated(const std::string& sigma, double sigma_px) {
  const std::string known = sigma == "estimated" ? fmt::format("estimated, from {:g} px on", sigma_px)
                                                 : fmt::format("taken as {:g} px", sigma_px);
  return fmt::format("none: each match has a weight, by its distance and by sigma ({})", known);
}

// The rules to try; fixed before any trial.
constexpr double kProbabilities[] = {0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 1.0};

// The level for one rule of one estimator.
double ComputeDelta(int num_estimators) {
  return 0.05 / (static_cast<double>(std::size(kProbabilities)) * num_estimators);
}

constexpr const char* kErrorMeasure = "max_error_median_deg";

// Times that differ by less are alike: they depend on what else the machine does.
constexpr double kAlikeTimes = 1.1;

// A quantity of an estimator with its n; an empty Estimate if the summary lacks it.
Estimate FindEstimate(const Summary& summary, const std::string& label, const std::string& quantity) {
  for (const SummaryRow& row : summary.rows) {
    if (row.estimator == label && row.quantity == quantity) return MakeEstimate(row, /*num_trials=*/-1);
  }
  return {};
}

// Gives a share of n the exact interval that holds jointly with those of all estimators (Bonferroni), and
// removes its note, which is from a narrower interval.
Estimate WidenForChoice(Estimate share, int num_estimators) {
  const std::int64_t n = share.n.value_or(0);
  if (n == 0 || std::isnan(share.value)) return share;
  share.interval = ExactBinomialInterval(std::llround(share.value * static_cast<double>(n)), n,
                                         1.0 - 0.05 / num_estimators);
  share.note.clear();
  return share;
}

// Without a true direction the rotation is all that there is to find. An answer that refuses the direction
// then counts as one that gives the rotation.
ReadableRun ReadForQuestion(const ResultStore& store, bool has_direction) {
  if (has_direction) return ReadRun(store);
  return {store.Description(), [&store](const VisitTrial& visit) {
            store.ForEachTrial([&](const ProblemRecord& problem, std::vector<TrialRecord> records) {
              for (TrialRecord& record : records) {
                if (record.status == MotionStatus::kDirectionNotObservable) record.status = MotionStatus::kOk;
              }
              visit(problem, records);
            });
          }};
}

// The difference of an estimator's errors from those of the reference, on the same trials.
Estimate FindErrorDifference(const Comparison& comparison, const std::string& label) {
  for (const ComparisonRow& row : comparison.rows) {
    if (row.estimator == label && row.event == kErrorMeasure)
      return {.value = row.difference, .interval = row.interval, .n = row.n};
  }
  return {};
}

bool HasGreaterErrors(const Comparison& comparison, const std::string& label) {
  return FindErrorDifference(comparison, label).interval.lower > 0.0;
}

// The best first. `summary`: of the answers as they were given; `of_question`: of those of `run`.
std::vector<AskedEstimator> ListRanked(const ReadableRun& run, const Summary& summary,
                                       const Summary& of_question, const Question& question) {
  const std::vector<DescribedEstimator>& estimators = run.description.estimators;
  std::vector<AskedEstimator> ranked;
  for (const DescribedEstimator& estimator : estimators) {
    const std::string& label = estimator.label;
    const Estimate success = FindEstimate(of_question, label, "success");
    ranked.push_back({label, WidenForChoice(success, static_cast<int>(estimators.size())),
                      FindEstimate(summary, label, "mean_time_ms").value,
                      FindEstimate(of_question, label, kErrorMeasure).value,
                      FindEstimate(summary, label, "failure_probability").n.value_or(0) > 0,
                      DescribeInlierThreshold(estimator.name, estimator.options, question),
                      FindEstimate(summary, label, "nees_coverage").value});
  }
  std::vector<Comparison> comparisons;
  for (const AskedEstimator& estimator : ranked)
    comparisons.push_back(Compare(run, estimator.label, {.compared = {kErrorMeasure}}));
  RankEstimators(&ranked, [&](const AskedEstimator& worse, const AskedEstimator& better) {
    return std::ranges::any_of(comparisons, [&](const Comparison& comparison) {
      return comparison.reference == better.label && HasGreaterErrors(comparison, worse.label);
    });
  });
  return ranked;
}

// Holm's p-values are of K - 1 comparisons with a reference that is named beforehand. The best is found by
// the same trials and may be any of the K estimators, so that each of the K (K - 1) / 2 pairs may be
// compared: K / 2 times as many.
double CountChoices(const Comparison& comparison) {
  return 0.5 * (static_cast<double>(comparison.rows.size()) + 1.0);
}
double AdjustedPValue(const ComparisonRow& row, const Comparison& comparison) {
  return std::min(row.holm_p_value * CountChoices(comparison), 1.0);
}
bool IsMoreThanChance(const ComparisonRow& row, const Comparison& comparison) {
  return row.n > 0 && AdjustedPValue(row, comparison) < 0.05;
}

// The estimators whose rate of failure or refusal does not differ significantly from that of the best.
std::vector<AskedEstimator> FindAlike(const std::vector<AskedEstimator>& ranked,
                                      const Comparison& comparison) {
  std::vector<AskedEstimator> alike(ranked.begin() + 1, ranked.end());
  std::erase_if(alike, [&](const AskedEstimator& estimator) {
    return std::ranges::any_of(comparison.rows, [&](const ComparisonRow& row) {
      return row.estimator == estimator.label && IsMoreThanChance(row, comparison);
    });
  });
  return alike;
}

// The interval of a difference, adjusted for all comparisons in agreement with Holm's verdict (Strassburger
// and Bretz 2008, Statistics in Medicine 27:4914): those that are not told apart share the level, and their
// intervals contain 0, which the exact test does not reject. Of a proven difference it is Bonferroni's, on
// the proven side of 0.
Interval AdjustInterval(const ComparisonRow& row, const Comparison& comparison, size_t num_undecided) {
  const bool is_told_apart = IsMoreThanChance(row, comparison);
  const size_t num_shares = is_told_apart ? comparison.rows.size() : num_undecided;
  const double level = 0.05 / CountChoices(comparison) / static_cast<double>(num_shares);
  const Interval interval = RiskDifferenceInterval(row.counts, 1.0 - level);
  if (!is_told_apart) return {std::min(interval.lower, 0.0), std::max(interval.upper, 0.0)};
  return row.difference > 0.0 ? Interval{std::max(interval.lower, 0.0), interval.upper}
                              : Interval{interval.lower, std::min(interval.upper, 0.0)};
}

// The difference in success, from the comparison of failures and refusals. Holm's step-down tests the least
// p-value of `num_undecided` at its share of the level, so trials are planned at that level.
std::optional<AskedDifference> DescribeDifference(const Comparison& comparison, const std::string& other,
                                                  size_t num_undecided) {
  for (const ComparisonRow& row : comparison.rows) {
    if (row.estimator != other || row.n == 0) continue;
    const auto n = static_cast<double>(row.n);
    const double best_only = static_cast<double>(row.counts.first_only) / n;
    const double other_only = static_cast<double>(row.counts.second_only) / n;
    const double level =
        0.05 / CountChoices(comparison) / static_cast<double>(std::max<size_t>(num_undecided, 1));
    const double discordant = std::max(best_only + other_only, kPlainDifference);
    return AskedDifference{
        {.value = row.difference, .interval = AdjustInterval(row, comparison, num_undecided)},
        AdjustedPValue(row, comparison),
        TrialsToTellApart(best_only, other_only, level),
        TrialsToTellApart(0.5 * (discordant + kPlainDifference), 0.5 * (discordant - kPlainDifference),
                          level)};
  }
  return std::nullopt;
}

// The answers of an estimator that state a probability and whose truth is known.
std::vector<StatedAnswer> CollectStated(const std::vector<FailureForecasts>& all, const std::string& label) {
  std::vector<StatedAnswer> answers;
  for (const FailureForecasts& of_one : all) {
    if (of_one.estimator != label || of_one.source != ForecastSource::kStated) continue;
    for (const Forecast& forecast : of_one.forecasts)
      answers.push_back({forecast.probability, forecast.happened});
  }
  return answers;
}

Estimate EstimateFailed(const std::vector<StatedAnswer>& answers) {
  const auto n = static_cast<std::int64_t>(answers.size());
  const std::int64_t failed = std::ranges::count(answers, true, &StatedAnswer::has_failed);
  return {.value = static_cast<double>(failed) / static_cast<double>(n), .n = n};
}

// Sets `stating`, `rule`, `stated` and `failed`.
void AddStated(const ResultStore& run, const Summary& summary, Answer* answer) {
  std::vector<std::string> labels = {answer->best.label};
  for (const AskedEstimator& estimator : answer->alike) labels.push_back(estimator.label);
  const std::vector<FailureForecasts> all = CollectFailureForecasts(run);
  for (const std::string& label : labels) {
    const std::vector<StatedAnswer> stated = CollectStated(all, label);
    if (stated.empty()) continue;
    answer->stating = label;
    answer->rule = CertifyAcceptRule(stated, answer->num_trials, answer->at_most, answer->num_estimators);
    answer->stated = FindEstimate(summary, label, "failure_probability");
    answer->failed = WidenForChoice(EstimateFailed(stated), answer->num_estimators);
    return;
  }
}

// Sets `coverage`, by the interval that allows for the choice, and what is judged of it.
void AddCoverage(const Estimate& coverage, Answer* a) {
  a->coverage = WidenForChoice(coverage, a->num_estimators);
  const std::int64_t n = coverage.n.value_or(0);
  if (n == 0) return;
  a->coverage_verdict =
      JudgeCoverage(coverage.value, a->coverage.interval, n, a->num_trials, /*is_of_fixed_n=*/true).verdict;
  a->trials_to_confirm_coverage = TrialsToDecide(kNominalCoverage, Around(kNominalCoverage, kCoverageMargin),
                                                 1.0 - 0.05 / a->num_estimators) *
                                  static_cast<double>(a->num_trials) / static_cast<double>(n);
}

}  // namespace

std::optional<AcceptRule> CertifyAcceptRule(const std::vector<StatedAnswer>& answers, std::int64_t num_trials,
                                            double at_most, int num_estimators) {
  std::optional<AcceptRule> greatest;
  for (const double probability : kProbabilities) {
    ErrorCount accepted;
    for (const StatedAnswer& answer : answers) {
      if (answer.failure_probability > probability) continue;
      ++accepted.n;
      accepted.errors += answer.has_failed;
    }
    if (ExcessPValue(accepted, at_most) <= ComputeDelta(num_estimators))
      greatest = AcceptRule{probability, accepted, num_trials};
  }
  return greatest;
}

std::int64_t FewestCertifyingAnswers(double at_most, int num_estimators) {
  return FewestCertifyingTrials(at_most, ComputeDelta(num_estimators));
}

void RankEstimators(std::vector<AskedEstimator>* estimators, const HasGreaterError& has_greater_error) {
  const auto last_if_nan = [](double value) {
    return std::isnan(value) ? std::numeric_limits<double>::infinity() : value;
  };
  std::ranges::stable_sort(*estimators, {}, [&](const AskedEstimator& estimator) {
    return std::array{last_if_nan(-estimator.success.value), last_if_nan(estimator.time_ms)};
  });
  for (auto first = estimators->begin(); first != estimators->end(); ++first) {
    const auto end_of_ties = std::find_if(first, estimators->end(), [&](const AskedEstimator& other) {
      return other.success.value != first->success.value;
    });
    const auto is_candidate = [&](const AskedEstimator& estimator) {
      return std::none_of(first, end_of_ties,
                          [&](const AskedEstimator& other) { return has_greater_error(estimator, other); });
    };
    auto chosen = std::find_if(first, end_of_ties, is_candidate);
    if (chosen == end_of_ties) continue;
    const auto stating = std::find_if(chosen, end_of_ties, [&](const AskedEstimator& estimator) {
      return estimator.states_p && estimator.time_ms <= kAlikeTimes * chosen->time_ms &&
             is_candidate(estimator);
    });
    if (stating != end_of_ties) chosen = stating;
    std::rotate(first, chosen, chosen + 1);
  }
}

Answer AnswerQuestion(const ResultStore& run, const Question& question, double at_most) {
  const ReadableRun readable = ReadForQuestion(run, HasDirection(question));
  const RunDescription& description = readable.description;
  if (description.conditions.size() != 1)
    throw InputError(fmt::format("ask: {}: has {} conditions; an answer is of one", description.study,
                                 description.conditions.size()));
  const Summary summary = Summarize(run, /*with_times=*/true);
  // Both have the same answers unless the question has no direction (ReadForQuestion).
  const Summary of_question = HasDirection(question) ? summary : Summarize(readable, /*with_times=*/false);
  const std::vector<AskedEstimator> ranked = ListRanked(readable, summary, of_question, question);
  Answer answer;
  answer.num_trials = summary.num_trials_done;
  answer.num_estimators = static_cast<int>(ranked.size());
  answer.has_direction = HasDirection(question);
  answer.focal_error = question.focal_error;
  answer.at_most = at_most;
  answer.failure = description.failure;
  answer.best = ranked.front();
  answer.works = !(answer.best.success.interval.upper < kLeastSuccess);
  if (ranked.size() > 1) {
    const Comparison comparison = Compare(readable, answer.best.label, {.compared = {"failure_or_refusal"}});
    answer.error_difference = FindErrorDifference(
        Compare(readable, answer.best.label, {.compared = {kErrorMeasure}}), ranked[1].label);
    answer.next = ranked[1];
    answer.alike = FindAlike(ranked, comparison);
    answer.difference = DescribeDifference(comparison, answer.next->label, answer.alike.size());
  }
  if (answer.has_direction) AddStated(run, summary, &answer);
  const std::string& best = answer.best.label;
  answer.sharpness = {FindEstimate(summary, best, "sd_over_crb").value,
                      FindEstimate(summary, best, "rotation_sd_deg").value,
                      FindEstimate(summary, best, "direction_sd_deg").value};
  AddCoverage(FindEstimate(summary, best, "nees_coverage"), &answer);
  return answer;
}

InlierThreshold DescribeInlierThreshold(const std::string& name, const Settings& options,
                                        const Question& question) {
  const double sigma_px = question.sigma_px;
  if (name == "rcme_calibrated")
    return {kNaN, DescribeCalibrated(FindSetting(options, "sigma").value_or(""), sigma_px)};
  double level = 0.0, num_sigma = 0.0;
  const bool has_level = ParseReal(FindSetting(options, "significance_level").value_or(""), &level);
  const bool has_sigma = ParseReal(FindSetting(options, "threshold_sigma").value_or(""), &num_sigma);
  if (name == "msac" && has_level) return DescribeSampson(level, sigma_px);
  if (name == "rcme" && has_level) return {kNaN, DescribeTestOfHypothesis(level, sigma_px)};
  if (name == "opencv_usac" && has_sigma) return DescribeOpenCv(num_sigma, sigma_px);
  if (name == "opengv_ransac" && has_sigma) return DescribeOpenGv(num_sigma, sigma_px, question.focal_px);
  return {};
}

}  // namespace rcme
