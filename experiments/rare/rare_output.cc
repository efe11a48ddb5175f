#include "experiments/rare/rare_output.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "experiments/core/text/columns.h"
#include "experiments/core/text/field_text.h"
#include "experiments/core/text/json_output.h"
#include "stats/moments.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

std::string DoubtInWords(SplittingDoubt doubt, const RareCell& cell) {
  const SplittingRate& rate = cell.rate;
  switch (doubt) {
    case SplittingDoubt::kNoLevels:
      return fmt::format(
          "no levels lead to failure: the error came to {:.3g} of its bound{}", cell.pilot.last_level,
          cell.pilot.end == PilotEnd::kTooRare ? fmt::format(" at a rate below {:g}", kLeastSplittingRate)
                                               : ", which nothing exceeds");
    case SplittingDoubt::kReplicateLost:
      return "a replicate lost all its particles: more particles may do";
    case SplittingDoubt::kReplicatesDisagree:
      return fmt::format(
          "replicates disagree (relative standard deviation {:.2g}): a few hold most of the rate, "
          "as where failures come at once and no level leads to them",
          rate.relative_spread);
    case SplittingDoubt::kDrawsDisagree:
      return "the first particles, which are plain trials, hold more or fewer failures than the interval "
             "allows";
    case SplittingDoubt::kMovesStuck:
      return fmt::format("at some level only {:.2g} of the moves were accepted", rate.least_acceptance);
  }
  return "";
}

std::string DoubtsInWords(const RareCell& cell) {
  std::vector<std::string> words;
  for (const SplittingDoubt doubt : cell.rate.doubts) words.push_back(DoubtInWords(doubt, cell));
  return fmt::format("{}", fmt::join(words, "; "));
}

std::vector<std::string> HeadOf(const StudyPlan& plan, size_t condition, size_t estimator) {
  std::vector<std::string> head = plan.conditions[condition].levels;
  head.push_back(plan.study.estimators[estimator].label);
  return head;
}

std::vector<std::string> FirstRow(const StudyPlan& plan, const std::vector<std::string>& more) {
  std::vector<std::string> row = plan.factor_names;
  row.push_back("estimator");
  row.insert(row.end(), more.begin(), more.end());
  return row;
}

std::string RateInWords(const RareRow& row) {
  if (std::isnan(row.estimate)) return "-";
  return fmt::format("{:.2e} [{:.1e}, {:.1e}]", row.estimate, row.interval.lower, row.interval.upper);
}

std::string ShareInWords(double share) {
  return std::isfinite(share) ? fmt::format("{:.2g} %", 100.0 * share) : "-";
}

// The columns that all rates have.
std::vector<std::string> CellsInWords(const StudyPlan& plan, const RareRow& row) {
  std::vector<std::string> cells = HeadOf(plan, row.condition, row.estimator);
  cells.push_back(RateInWords(row));
  cells.push_back(fmt::format("{}", row.num_calls));
  cells.push_back(ShareInWords(row.BruteForceShare()));
  cells.push_back(fmt::format("{:.1e}", row.unseen_up_to));
  cells.push_back(row.doubts.empty() ? "yes" : "NO");
  return cells;
}

Json LevelsOf(const RareCell& cell) {
  std::vector<double> values = cell.pilot.levels.levels;
  values.push_back(1.0);
  Json levels = Json::array();
  for (size_t k = 0; k < values.size() && !cell.replicates.empty(); ++k) {
    Moments rates, acceptance;
    for (const SplittingReplicate& replicate : cell.replicates) {
      double rate = 1.0;
      for (size_t j = 0; j <= k; ++j) rate *= j < replicate.shares.size() ? replicate.shares[j] : 0.0;
      rates.Add(rate);
      if (k < replicate.acceptance.size()) acceptance.Add(replicate.acceptance[k]);
    }
    levels.push_back({{"error_over_bound", values[k]},
                      {"rate_beyond", JsonNumber(rates.mean())},
                      {"standard_error", JsonNumber(rates.standard_error())},
                      {"acceptance", JsonNumber(acceptance.mean())}});
  }
  return levels;
}

Json RowAsJson(const StudyPlan& plan, const RareRow& row) {
  return {{"condition", row.condition},
          {"levels", plan.conditions[row.condition].levels},
          {"estimator", plan.study.estimators[row.estimator].label},
          {"value", JsonNumber(row.estimate)},
          {"lower", JsonNumber(row.interval.lower)},
          {"upper", JsonNumber(row.interval.upper)},
          {"standard_error", JsonNumber(row.standard_error)},
          {"is_trusted", row.doubts.empty()},
          {"doubts", row.doubts},
          {"unseen_up_to", JsonNumber(row.unseen_up_to)},
          {"num_calls", row.num_calls},
          {"brute_force_share", JsonNumber(row.BruteForceShare())}};
}

Json StudyAsJson(const StudyPlan& plan, const char* method) {
  return {{"study", plan.study.name},
          {"seed", plan.study.seed},
          {"factors", plan.factor_names},
          {"method", method}};
}

}  // namespace

double RareRow::BruteForceShare() const {
  const double relative_error = standard_error / estimate;
  return static_cast<double>(num_calls) * estimate * relative_error * relative_error / (1.0 - estimate);
}

RareRow RowOf(const RareCell& cell) {
  const SplittingRate& rate = cell.rate;
  RareRow row{cell.condition,      cell.estimator,       rate.estimate,
              rate.standard_error, rate.interval,        rate.num_values,
              rate.unseen_up_to,   rate.relative_spread, {}};
  for (const SplittingDoubt doubt : rate.doubts) row.doubts.push_back(Name(doubt));
  return row;
}

RareRow RowOf(const StratifiedCell& cell) {
  RareRow row{cell.condition,
              cell.estimator,
              cell.rate.estimate,
              cell.rate.standard_error,
              cell.rate.interval,
              cell.num_run,
              cell.rate.cautious_upper,
              std::numeric_limits<double>::quiet_NaN(),
              {}};
  if (cell.rate.num_effective_events < kLeastFailures) row.doubts = {"few_failures"};
  return row;
}

std::string RareAsTable(const StudyPlan& plan, const std::vector<RareCell>& cells) {
  std::vector<std::vector<std::string>> rows = {
      FirstRow(plan, {"failure", "calls", "of brute force", "unseen up to", "trusted", "spread"})};
  std::string doubts;
  for (const RareCell& cell : cells) {
    rows.push_back(CellsInWords(plan, RowOf(cell)));
    rows.back().push_back(fmt::format("{:.2f}", cell.rate.relative_spread));
    if (cell.rate.IsTrusted()) continue;
    doubts += fmt::format("{}: not trusted: {}\n",
                          fmt::join(HeadOf(plan, cell.condition, cell.estimator), ", "), DoubtsInWords(cell));
  }
  return fmt::format(
      "{}: failures by multilevel splitting\n\n{}\n{}{}"
      "Mean of independent unbiased replicates with Cox's 95 % interval; spread: standard deviation of one "
      "over "
      "the mean.\n"
      "of brute force: calls, of those after which plain trials would have the same standard error.\n"
      "unseen up to: failures of a kind that comes at once, with no level before it, may have any rate up to "
      "this\n"
      "and be missed; the rate is that of failures to which levels lead.\n",
      plan.study.name, FormatColumns(rows), doubts, doubts.empty() ? "" : "\n");
}

std::string StratifiedAsTable(const StudyPlan& plan, const std::vector<StratifiedCell>& cells) {
  std::vector<std::string> head =
      FirstRow(plan, {"failure", "calls", "of brute force", "unseen up to", "trusted"});
  for (int k = 0; k < kNumStrata; ++k) head.push_back(fmt::format("1 in {}", 1 << k));
  std::vector<std::vector<std::string>> rows = {head};
  for (const StratifiedCell& cell : cells) {
    rows.push_back(CellsInWords(plan, RowOf(cell)));
    for (const StratumCount& count : cell.strata)
      rows.back().push_back(fmt::format("{}/{}/{}", count.num_failed, count.num_run, count.num_trials));
  }
  return fmt::format(
      "{}: failures of trials stratified by the Cramer-Rao bound\n\n{}\n"
      "Each trial that is run counts as many as its stratum stands for; 95 % interval of Fay and Feuer for "
      "weighted "
      "counts.\n"
      "of brute force: calls, of those after which plain trials would have the same standard error.\n"
      "unseen up to: the upper end if the next failure came from the easiest stratum that was run.\n"
      "trusted: the failures weigh as much as {:g} of equal weight or more. 1 in k: of the trials of a "
      "stratum one in\n"
      "k is run: failed/run/drawn.\n",
      plan.study.name, FormatColumns(rows), kLeastFailures);
}

std::string RareAsCsv(const StudyPlan& plan, const std::vector<RareRow>& rows) {
  std::string text = "study,condition";
  for (const std::string& factor : plan.factor_names) text += fmt::format(",{}", CsvField(factor));
  text +=
      ",estimator,quantity,kind,value,lower,upper,standard_error,n,trusted,doubts,unseen_up_to,"
      "relative_spread,brute_force_share\n";
  for (const RareRow& row : rows) {
    text += fmt::format("{},{}", CsvField(plan.study.name), row.condition);
    for (const std::string& name : HeadOf(plan, row.condition, row.estimator))
      text += fmt::format(",{}", CsvField(name));
    text += fmt::format(",failure,rate,{},{},{},{},{},{},{},{},{},{}\n", CsvNumber(row.estimate),
                        CsvNumber(row.interval.lower), CsvNumber(row.interval.upper),
                        CsvNumber(row.standard_error), row.num_calls, row.doubts.empty() ? 1 : 0,
                        fmt::join(row.doubts, " "), CsvNumber(row.unseen_up_to),
                        CsvNumber(row.relative_spread), CsvFinite(row.BruteForceShare()));
  }
  return text;
}

std::string RareAsJson(const StudyPlan& plan, const RareEffort& effort, const std::vector<RareCell>& cells) {
  Json all = Json::array();
  for (const RareCell& cell : cells) {
    Json estimates = Json::array();
    for (const SplittingReplicate& replicate : cell.replicates) estimates.push_back(replicate.estimate);
    all.push_back(RowAsJson(plan, RowOf(cell)));
    all.back().update({{"relative_spread", JsonNumber(cell.rate.relative_spread)},
                       {"num_ancestors", cell.rate.num_ancestors},
                       {"error_levels", LevelsOf(cell)},
                       {"replicates", estimates}});
  }
  Json json = StudyAsJson(plan, "splitting");
  json.update({{"num_particles", effort.splitting.num_particles},
               {"num_moves", effort.splitting.num_moves},
               {"kept_share", effort.splitting.kept_share},
               {"num_replicates", effort.num_replicates},
               {"cells", all}});
  return JsonText(kRareFormat, json);
}

std::string StratifiedAsJson(const StudyPlan& plan, const StratifiedEffort& effort,
                             const std::vector<StratifiedCell>& cells) {
  Json all = Json::array();
  for (const StratifiedCell& cell : cells) {
    Json strata = Json::array();
    for (int k = 0; k < kNumStrata; ++k) {
      const StratumCount& count = cell.strata[static_cast<size_t>(k)];
      strata.push_back({{"one_in", 1 << k},
                        {"num_trials", count.num_trials},
                        {"num_run", count.num_run},
                        {"num_failed", count.num_failed}});
    }
    all.push_back(RowAsJson(plan, RowOf(cell)));
    all.back()["strata"] = strata;
  }
  Json json = StudyAsJson(plan, "stratified");
  json.update({{"num_trials", effort.num_trials}, {"run_share", effort.run_share}, {"cells", all}});
  return JsonText(kRareFormat, json);
}

}  // namespace rcme
