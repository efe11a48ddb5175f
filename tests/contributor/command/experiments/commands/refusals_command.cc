#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/table/render_table.h"
#include "experiments/run/store/result_store.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"

namespace rcme {
namespace {

// How often one estimator answered with one status.
struct StatusCount {
  std::string group, estimator;
  MotionStatus status = MotionStatus::kOk;
  std::int64_t count = 0, n = 0;  // of n trials
};

// The level of the factor `by` of each condition; "" of all without one.
std::vector<std::string> GroupOfConditions(const RunDescription& run, const std::string& by) {
  std::vector<std::string> groups;
  const auto place = std::ranges::find(run.factors, by);
  if (!by.empty() && place == run.factors.end()) {
    throw InputError(fmt::format("--by: study '{}' has no factor {}; allowed: {}", run.study, Quoted(by),
                                 fmt::join(run.factors, ", ")));
  }
  for (const DescribedCondition& condition : run.conditions) {
    const auto factor = static_cast<size_t>(place - run.factors.begin());
    groups.push_back(by.empty() ? "" : condition.levels[factor]);
  }
  return groups;
}

// Every status that an estimator gave without a motion, by group, estimator and status.
std::vector<StatusCount> CountRefusals(const ResultStore& store, const std::string& by) {
  using Key = std::tuple<size_t, std::uint32_t, MotionStatus>;  // place of the group, estimator
  const RunDescription run = store.Description();
  const std::vector<std::string> group_of = GroupOfConditions(run, by);
  std::map<Key, std::int64_t> counts;
  std::map<std::pair<size_t, std::uint32_t>, std::int64_t> totals;
  store.ForEachRecord([&](const TrialRecord& record) {
    const std::string& name = group_of[record.condition];
    const auto group = static_cast<size_t>(std::ranges::find(group_of, name) - group_of.begin());
    ++totals[{group, record.estimator}];
    if (HasRefused(record)) ++counts[{group, record.estimator, record.status}];
  });
  std::vector<StatusCount> rows;
  for (const auto& [key, count] : counts) {
    const auto& [group, estimator, status] = key;
    rows.push_back(
        {group_of[group], run.estimators[estimator].label, status, count, totals[{group, estimator}]});
  }
  return rows;
}

Table MakeTable(const std::vector<StatusCount>& counts, const std::string& by) {
  using R = const StatusCount&;
  std::vector<ColumnOf<StatusCount>> columns = {
      {{.name = "estimator", .is_key = true}, [](R r) { return r.estimator; }},
      {{.name = "status", .is_key = true}, [](R r) { return StatusName(r.status); }},
      {{"n", ColumnType::kCount}, [](R r) { return r.n; }},
      {{"rate", ColumnType::kEstimate, kPercent}, [](R r) {
         return Estimate{static_cast<double>(r.count) / static_cast<double>(r.n),
                         ExactBinomialInterval(r.count, r.n)};
       }}};
  if (!by.empty())
    columns.insert(columns.begin(), {{.name = by, .is_key = true}, [](R r) { return r.group; }});
  return MakeTable(columns, counts);
}

}  // namespace

void AddRefusalsCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("refusals", "Why do estimators refuse, and how often? From a result file");
  command->footer(
      "Of every estimator, each reason for an answer without a motion, as a share of all trials with\n"
      "the exact 95 % interval.\n"
      "\n"
      "Examples:\n"
      "  rcme refusals run.sqlite\n"
      "  rcme refusals run.sqlite --by outlier_ratio --format csv --out refusals.csv");
  struct Arguments {
    std::string run, by, format = "table", out;
  };
  auto arguments = std::make_shared<Arguments>();
  command->add_option("run", arguments->run, "result file of `rcme run`")->required();
  command->add_option("--by", arguments->by, "a factor of the study: its levels apart");
  command->add_option("--format", arguments->format, "table (for people) or csv (for programs)")
      ->check(MakeChoiceValidator({"table", "csv"}))
      ->capture_default_str();
  command->add_option("-o,--out", arguments->out, "write here instead of standard output");
  command->callback([arguments] {
    const ResultStore store = ResultStore::OpenForReading(arguments->run);
    const Table table = MakeTable(CountRefusals(store, arguments->by), arguments->by);
    PrintOrWrite(arguments->out, arguments->format == "csv" ? RenderCsv(table) : RenderText(table));
  });
}

}  // namespace rcme
