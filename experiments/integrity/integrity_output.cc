#include "experiments/integrity/integrity_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>

#include "experiments/core/table/render_table.h"
#include "experiments/core/text/columns.h"
#include "experiments/core/text/json_output.h"
#include "experiments/core/text/pick_name.h"
#include "experiments/trial/truth_error.h"
#include "stats/clustered_estimate.h"
#include "stats/intervals.h"
#include "stats/risk_control.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kMostConditionsInText = 40;
const NumberFormat kRate{100.0, "%", ".3g", ".2g"};

using CountOfTally = std::function<std::int64_t(const IntegrityTally&)>;

Interval FindClusteredInterval(const std::vector<IntegrityTally>& clusters, const CountOfTally& happened,
                               const CountOfTally& among) {
  std::vector<double> numbers;
  std::vector<std::int64_t> places;
  for (size_t c = 0; c < clusters.size(); ++c) {
    const std::int64_t k = happened(clusters[c]), n = among(clusters[c]);
    for (std::int64_t i = 0; i < n; ++i) {
      numbers.push_back(i < k ? 1.0 : 0.0);
      places.push_back(static_cast<std::int64_t>(c));
    }
  }
  return MeasureBoundedClusteredMean(numbers, {0.0, 1.0}, places).interval;
}

Estimate MeasureTallies(const std::vector<IntegrityTally>& clusters, bool by_trial,
                        const CountOfTally& happened, const CountOfTally& among) {
  std::int64_t k = 0, n = 0;
  for (const IntegrityTally& cluster : clusters) {
    k += happened(cluster);
    n += among(cluster);
  }
  if (n == 0) return {};
  return {
      .value = static_cast<double>(k) / static_cast<double>(n),
      .interval = by_trial ? ExactBinomialInterval(k, n) : FindClusteredInterval(clusters, happened, among)};
}

// The clusters of one condition or of all conditions, as for MeasureIntegrity.
struct TallyClusters {
  std::vector<IntegrityTally> tallies;
  bool by_trial = true;
};

TallyClusters ClustersFrom(const std::map<std::int64_t, IntegrityTally>& scenes) {
  TallyClusters clusters;
  for (const auto& [number, tally] : scenes) {
    clusters.tallies.push_back(tally);
    clusters.by_trial = clusters.by_trial && tally.NumTrials(0) <= 1 && tally.NumTrials(1) <= 1;
  }
  return clusters;
}

TallyClusters ListTallyClusters(const ConditionIntegrity& condition) {
  if (condition.scenes.empty()) return {{condition.counts.tally}, true};
  return ClustersFrom(condition.scenes);
}

// One cluster per draw of a population or real scene.
TallyClusters ListGroups(const std::vector<ConditionIntegrity>& conditions) {
  std::map<std::int64_t, IntegrityTally> groups;
  for (const ConditionIntegrity& condition : conditions) groups[condition.group].Add(condition.counts.tally);
  TallyClusters clusters = ClustersFrom(groups);
  clusters.by_trial = false;
  return clusters;
}

TallyClusters ListTallyClusters(const IntegrityReport& report) {
  if (report.new_problem == NewProblem::kCondition) return ListGroups(report.conditions);
  TallyClusters all;
  std::map<std::int64_t, IntegrityTally> common;
  all.by_trial = true;
  for (const ConditionIntegrity& condition : report.conditions) {
    for (const auto& [number, tally] : condition.scenes) common[number].Add(tally);
    const TallyClusters of = ListTallyClusters(condition);
    all.by_trial = all.by_trial && of.by_trial;
    all.tallies.insert(all.tallies.end(), of.tallies.begin(), of.tallies.end());
  }
  return report.has_common_scenes && !common.empty() ? ClustersFrom(common) : all;
}

struct IntegrityRow {
  std::vector<std::string> levels;
  size_t quantity = 0;
  std::int64_t num_trials = 0, num_answers = 0;
  IntegrityRates rates;
};

IntegrityRow MakeRow(const IntegrityReport& report, const ConditionIntegrity& condition, size_t quantity) {
  const TallyClusters clusters = ListTallyClusters(condition);
  return {condition.levels, quantity, condition.counts.tally.NumTrials(quantity),
          condition.counts.tally.NumAnswers(quantity),
          MeasureIntegrity(clusters.tallies, clusters.by_trial, quantity, report.terms.risk)};
}

IntegrityCounts CountAll(const IntegrityReport& report) {
  IntegrityCounts all;
  for (const ConditionIntegrity& condition : report.conditions) all.Add(condition.counts);
  return all;
}

enum class TableFor { kPeople, kFile };  // JSON has a rate and its interval in keys of their own

void AddRate(const std::string& name, Estimate IntegrityRates::*rate, TableFor table_for,
             std::vector<ColumnOf<IntegrityRow>>* columns) {
  using R = const IntegrityRow&;
  if (table_for == TableFor::kPeople) {
    columns->push_back({Column::Estimated(name, kRate), [rate](R row) { return row.rates.*rate; }});
    return;
  }
  columns->push_back({Column::Number(name), [rate](R row) { return (row.rates.*rate).value; }});
  columns->push_back({Column::Bounds(name), [rate](R row) { return (row.rates.*rate).interval; }});
}

Table MakeIntegrityTable(std::vector<ColumnOf<IntegrityRow>> columns, TableFor table_for,
                         const std::vector<IntegrityRow>& rows) {
  using R = const IntegrityRow&;
  columns.push_back({Column::Count("trials"), [](R row) { return row.num_trials; }});
  columns.push_back({Column::Count("answers"), [](R row) { return row.num_answers; }});
  AddRate("available", &IntegrityRates::available, table_for, &columns);
  AddRate("misleading", &IntegrityRates::misleading, table_for, &columns);
  AddRate("hazardous", &IntegrityRates::hazardous, table_for, &columns);
  columns.push_back({Column::Text("risk"), [](R row) {
                       return std::string(row.quantity == kEither ? "-" : Name(row.rates.verdict));
                     }});
  return MakeTable(columns, rows);
}

const ColumnOf<IntegrityRow> kQuantityColumn = {
    Column::Key("error"), [](const IntegrityRow& row) { return IntegrityQuantityName(row.quantity); }};

Table MakeTableOfAll(const IntegrityReport& report, TableFor table_for) {
  const IntegrityCounts all = CountAll(report);
  std::vector<IntegrityRow> rows;
  for (size_t q = 0; q <= kEither; ++q)
    rows.push_back({{}, q, all.tally.NumTrials(q), all.tally.NumAnswers(q), MeasureIntegrity(report, q)});
  return MakeIntegrityTable({kQuantityColumn}, table_for, rows);
}

Table MakeTableOfConditions(const IntegrityReport& report, TableFor table_for, size_t most) {
  std::vector<IntegrityRow> rows;
  for (size_t c = 0; c < report.conditions.size() && c < most; ++c) {
    for (size_t q = 0; q < kNumIntegrityQuantities; ++q)
      rows.push_back(MakeRow(report, report.conditions[c], q));
  }
  std::vector<ColumnOf<IntegrityRow>> keys = LevelColumns<IntegrityRow>(report.factors);
  keys.push_back(kQuantityColumn);
  return MakeIntegrityTable(keys, table_for, rows);
}

std::string DescribeCounts(const IntegrityReport& report) {
  const IntegrityCounts all = CountAll(report);
  std::string text = fmt::format(
      "{} on {}: {} trials, {} refused. Protection levels are for a risk of {:g} an answer; alert limits: {:g} deg of rotation, {:g} deg of direction.",
      report.estimator, report.study, all.tally.NumTrials(0) + all.num_unscored[0] + all.num_not_simulated,
      all.num_refusals, report.terms.risk, report.terms.rotation_limit_deg, report.terms.direction_limit_deg);
  if (all.num_invalid > 0)
    text += fmt::format(" {} answers are not valid: they count as trials without a motion.", all.num_invalid);
  for (size_t q = 0; q < kNumIntegrityQuantities; ++q) {
    if (all.num_unscored[q] > 0)
      text += fmt::format(" The true {} of {} answers is not known; they are left out.",
                          IntegrityQuantityName(q), all.num_unscored[q]);
  }
  if (all.num_not_simulated > 0)
    text += fmt::format(" {} trials could not be simulated; they are left out.", all.num_not_simulated);
  return FormatParagraph(text);
}

// Empty where every truth is exact.
std::string DescribeTruth(const IntegrityReport& report) {
  if (!report.has_real_truth) return "";
  const IntegrityCounts all = CountAll(report);
  const TruthSensitivity& sensitivity = all.truth_sensitivity;
  const bool is_sd_stated = sensitivity.num_inexact[0] + sensitivity.num_inexact[1] > 0;
  std::string text = DescribeRealTruth(is_sd_stated);
  if (!is_sd_stated) return FormatParagraph(text);
  for (size_t q = 0; q < kNumIntegrityQuantities; ++q) {
    const auto percent = [](std::int64_t count, std::int64_t n) {
      return n == 0 ? 0.0 : 100.0 * static_cast<double>(count) / static_cast<double>(n);
    };
    const std::int64_t num_answers = all.tally.NumAnswers(q), num_trials = all.tally.NumTrials(q);
    text += fmt::format(
        " Were each truth off by {:g} of its own standard deviations (truth_sd, of {} of {} answers), {} "
        "would be misleading in {:.3g} to {:.3g} % and hazardous in {:.3g} to {:.3g} %.",
        kTruthErrorSds, sensitivity.num_inexact[q], num_answers, IntegrityQuantityName(q),
        percent(sensitivity.misleading[q].least, num_answers),
        percent(sensitivity.misleading[q].most, num_answers),
        percent(sensitivity.hazardous[q].least, num_trials),
        percent(sensitivity.hazardous[q].most, num_trials));
  }
  return FormatParagraph(text);
}

std::string DescribeColumns(const IntegrityReport& report) {
  return FormatParagraph(fmt::format(
      "available: of all trials, those with a protection level within the alert limit; misleading: of the "
      "answers, those with an error beyond their level, which the risk promises to be at most {:g} %; "
      "hazardous: of all trials, those with an error beyond the alert limit and a level within. either: "
      "misleading or hazardous in rotation or in direction, available in both; its interval is of that rate "
      "itself. The risk is promised for rotation and direction each, and so for either at most twice. risk: "
      "exceeded or kept where the whole interval of misleading is on that side. Intervals are 95 %{}.",
      100.0 * report.terms.risk,
      report.new_problem == NewProblem::kCondition
          ? ", over all conditions for problems of a new condition or scene"
          : ""));
}

// Empty where the answers suffice, or where trials that belong together leave no such number.
std::string DescribeFewestAnswers(const IntegrityReport& report) {
  constexpr double kTail = 0.025;  // of a 95 % interval
  const std::int64_t fewest = FewestCertifyingTrials(report.terms.risk, kTail);
  const IntegrityCounts all = CountAll(report);
  std::int64_t answers = fewest;
  for (size_t q = 0; q < kNumIntegrityQuantities; ++q) answers = std::min(answers, all.tally.NumAnswers(q));
  const bool is_open = JudgeRisk(report) == RiskVerdict::kUndecided;
  if (!is_open || answers == fewest || !ListTallyClusters(report).by_trial) return "";
  return FormatParagraph(fmt::format(
      "Undecided: at least {} answers, none of them misleading, are needed to show that a risk of {:g} is "
      "kept; --trials N takes more, or --risk R tests a greater one.",
      fewest, report.terms.risk));
}

Json RegionsAsJson(const RegionCounts& counts) {
  Json json = Json::object();
  for (size_t r = 0; r < kNumStanfordRegions; ++r) json[Name(static_cast<StanfordRegion>(r))] = counts[r];
  return json;
}

Json RenderTallyCells(const std::map<int, std::int64_t>& cells) {
  Json json = Json::array();
  for (const auto& [cell, count] : cells)
    json.push_back({{"error", cell / kNumIntegrityBins}, {"level", cell % kNumIntegrityBins}, {"n", count}});
  return json;
}

// The counts with each truth moved towards the answer, and away from it.
Json RangeAsJson(const TruthSensitivity::Range& range) { return Json::array({range.least, range.most}); }

Json DiagramAsJson(const IntegrityReport& report, const IntegrityCounts& all, size_t quantity) {
  return {{"error", IntegrityQuantityName(quantity)},
          {"alert_limit_deg", report.terms.LimitDeg(quantity)},
          {"trials", all.tally.NumTrials(quantity)},
          {"without_motion", all.tally.num_without_motion},
          {"without_truth", all.num_unscored[quantity]},
          {"inexact_truth", all.truth_sensitivity.num_inexact[quantity]},
          {"misleading_by_truth", RangeAsJson(all.truth_sensitivity.misleading[quantity])},
          {"hazardous_by_truth", RangeAsJson(all.truth_sensitivity.hazardous[quantity])},
          {"regions", RegionsAsJson(all.tally.regions[quantity])},
          {"cells", RenderTallyCells(all.cells[quantity])}};
}

}  // namespace

const char* Name(RiskVerdict verdict) { return PickName(verdict, {"kept", "exceeded", "undecided"}); }

IntegrityRates MeasureIntegrity(const std::vector<IntegrityTally>& clusters, bool by_trial, size_t quantity,
                                double risk) {
  using T = const IntegrityTally&;
  const CountOfTally trials = [=](T t) { return t.NumTrials(quantity); };
  const CountOfTally answers = [=](T t) { return t.NumAnswers(quantity); };
  const auto measure = [&](std::int64_t (IntegrityTally::*count)(size_t) const, const CountOfTally& among) {
    return MeasureTallies(
        clusters, by_trial, [=](T t) { return (t.*count)(quantity); }, among);
  };
  IntegrityRates rates{measure(&IntegrityTally::NumAvailable, trials),
                       measure(&IntegrityTally::NumMisleading, answers),
                       measure(&IntegrityTally::NumHazardous, trials)};
  const Interval& interval = rates.misleading.interval;
  if (interval.lower > risk) rates.verdict = RiskVerdict::kExceeded;
  if (interval.upper <= risk) rates.verdict = RiskVerdict::kKept;
  return rates;
}

IntegrityRates MeasureIntegrity(const IntegrityReport& report, size_t quantity) {
  const TallyClusters clusters = ListTallyClusters(report);
  return MeasureIntegrity(clusters.tallies, clusters.by_trial, quantity, report.terms.risk);
}

RiskVerdict JudgeRisk(const IntegrityReport& report) {
  bool is_open = false;
  for (size_t q = 0; q < kNumIntegrityQuantities; ++q) {
    const RiskVerdict verdict = MeasureIntegrity(report, q).verdict;
    if (verdict == RiskVerdict::kExceeded) return verdict;
    is_open = is_open || verdict == RiskVerdict::kUndecided;
  }
  return is_open ? RiskVerdict::kUndecided : RiskVerdict::kKept;
}

std::string IntegrityAsText(const IntegrityReport& report) {
  std::string text = DescribeCounts(report) + DescribeTruth(report) + "\n" +
                     RenderText(MakeTableOfAll(report, TableFor::kPeople)) + "\n";
  if (report.conditions.size() > 1) {
    text += RenderText(MakeTableOfConditions(report, TableFor::kPeople, kMostConditionsInText)) + "\n";
    if (report.conditions.size() > kMostConditionsInText)
      text += FormatParagraph(fmt::format("The first {} of {} conditions; integrity.json has all.",
                                          kMostConditionsInText, report.conditions.size()));
  }
  return text + DescribeColumns(report) + DescribeFewestAnswers(report);
}

std::string IntegrityAsJson(const IntegrityReport& report) {
  const IntegrityCounts all = CountAll(report);
  Json edges = Json::array(), diagrams = Json::array();
  for (int k = 0; k <= kNumIntegrityBins; ++k) edges.push_back(IntegrityEdgeDeg(k));
  for (size_t q = 0; q < kNumIntegrityQuantities; ++q) diagrams.push_back(DiagramAsJson(report, all, q));
  const Json json = {
      {"study", report.study},
      {"estimator", report.estimator},
      {"risk", report.terms.risk},
      {"refused", all.num_refusals},
      {"not_valid", all.num_invalid},
      {"not_simulated", all.num_not_simulated},
      {"new_problem", report.new_problem == NewProblem::kTrial ? "trial" : "condition"},
      {"edges_deg", std::move(edges)},
      {"diagrams", std::move(diagrams)},
      {"all", RenderJson(MakeTableOfAll(report, TableFor::kFile))},
      {"conditions", RenderJson(MakeTableOfConditions(report, TableFor::kFile, report.conditions.size()))}};
  return JsonText(kIntegrityFormat, json);
}

CommandResult MakeIntegrityResult(const IntegrityReport& report) {
  return {IntegrityAsText(report), MakeTableOfConditions(report, TableFor::kFile, report.conditions.size()),
          IntegrityAsJson(report)};
}

}  // namespace rcme
