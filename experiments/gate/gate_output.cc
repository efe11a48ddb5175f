#include "experiments/gate/gate_output.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "experiments/core/table/render_table.h"
#include "experiments/core/text/field_text.h"
#include "experiments/core/text/json_output.h"

namespace rcme {
namespace {

constexpr size_t kMaxListed = 10;  // changed trials; JSON has all of them

// The format for people: rates, scores and shares in percent, errors in degrees, times in ms.
NumberFormat LevelFormat(const GateQuantity& quantity) {
  if (quantity.name == "time") return {1e3, "ms", ".3g"};
  if (quantity.name == "error") return {1.0, "deg", ".3g"};
  return kPercent;
}
// Changes of rates and scores are differences of percentages, those of errors and times are relative.
std::string ChangeUnit(const GateQuantity& quantity) {
  return quantity.scale == GateScale::kRatio ? "%" : "points";
}

std::string FormatLevel(const GateQuantity& quantity, double level) {
  return FormatEstimate({.value = level}, LevelFormat(quantity));
}

std::string FormatChange(const GateRow& row) {
  const NumberFormat change{100.0, ChangeUnit(row.test.quantity), "+.2f"};
  return FormatEstimate({row.difference, row.interval}, row.test.is_limit ? kPercent : change);
}

std::string FormatMargin(const GateTest& test) {
  const double percent = 100.0 * test.margin;
  return test.is_limit ? fmt::format("at most {:.3g} %", percent)
                       : fmt::format("+{:.3g} {}", percent, ChangeUnit(test.quantity));
}

bool HasSize(const GateRow& row) { return !std::isnan(row.size_ratio); }
bool HasSizes(const GateReport& report) { return std::ranges::any_of(report.look.rows, HasSize); }

// Whether rates of the new version alone are compared with limits.
bool HasOnlyLimits(const GateReport& report) {
  return std::ranges::all_of(report.look.rows, [](const GateRow& row) { return row.test.is_limit; });
}
bool HasLimit(const GateReport& report) {
  return std::ranges::any_of(report.look.rows, [](const GateRow& row) { return row.test.is_limit; });
}

// "not worse", of a limit "below the limit".
std::string NameForPeople(const GateRow& row) {
  if (!row.test.is_limit) return Name(row.verdict);
  if (row.verdict == GateVerdict::kNotWorse) return "below the limit";
  return row.verdict == GateVerdict::kWorse ? "above the limit" : Name(row.verdict);
}

// The headings of the column with the change, of a limit the rate, and of the one with what it may be.
std::pair<std::string, std::string> NameChangeColumns(const GateReport& report) {
  if (HasOnlyLimits(report)) return {"rate", "limit"};
  return HasLimit(report) ? std::pair("change or rate", "margin or limit") : std::pair("change", "margin");
}

Table MakePeopleTable(const GateReport& report) {
  using R = const GateRow&;
  std::vector<ColumnOf<GateRow>> columns = {
      {{.name = "quantity", .is_key = true}, [](R r) { return r.test.Name(); }},
      {{"verdict"}, [](R r) { return NameForPeople(r); }},
      {{"pairs", ColumnType::kCount}, [](R r) { return r.n; }}};
  if (!report.old_label.empty())
    columns.push_back({{"old"}, [](R r) { return FormatLevel(r.test.quantity, r.of_old); }});
  columns.push_back({{"new"}, [](R r) { return FormatLevel(r.test.quantity, r.of_new); }});
  const auto [change, margin] = NameChangeColumns(report);
  columns.push_back({{change}, [](R r) { return FormatChange(r); }});
  columns.push_back({{margin}, [](R r) { return FormatMargin(r.test); }});
  if (HasSizes(report))
    columns.push_back({{"regions"}, [](R r) {
                         return HasSize(r) ? fmt::format("{:.3g} times as large", r.size_ratio) : "";
                       }});
  return MakeTable(columns, report.look.rows);
}

Table MakeFileTable(const GateReport& report) {
  using R = const GateRow&;
  const std::vector<ColumnOf<GateRow>> columns = {
      {{"quantity"}, [](R r) { return r.test.Name(); }},
      {{"verdict"}, [](R r) { return Name(r.verdict); }},
      {{"pairs", ColumnType::kCount}, [](R r) { return r.n; }},
      {{"old", ColumnType::kNumber}, [](R r) { return r.of_old; }},
      {{"new", ColumnType::kNumber}, [](R r) { return r.of_new; }},
      {{"change", ColumnType::kNumber}, [](R r) { return r.difference; }},
      {{"lower,upper", ColumnType::kInterval}, [](R r) { return r.interval; }},
      {{"margin", ColumnType::kNumber}, [](R r) { return r.test.margin; }},
      {{"size_ratio", ColumnType::kNumber}, [](R r) { return HasSize(r) ? Value(r.size_ratio) : Value(); }},
      {{"p_worse", ColumnType::kNumber}, [](R r) { return r.p_worse; }},
      {{"p_not_worse", ColumnType::kNumber}, [](R r) { return r.p_not_worse; }}};
  return MakeTable(columns, report.look.rows);
}

struct ListedTrial {
  ChangedTrial trial;
  std::vector<std::string> commands;
};

std::vector<ListedTrial> ListTrials(const GateReport& report, size_t most) {
  std::vector<ListedTrial> listed;
  for (const ChangedTrial& trial : report.changed) {
    if (listed.size() == most) break;
    listed.push_back({trial, {ShowCommand(report, trial)}});
    if (!report.show_old.empty()) listed.back().commands.push_back(ShowCommand(report, trial, true));
  }
  return listed;
}

Table MakeTrialTable(const std::vector<ListedTrial>& trials) {
  using T = const ListedTrial&;
  const std::vector<ColumnOf<ListedTrial>> columns = {
      {{"condition", ColumnType::kCount}, [](T t) { return std::int64_t{t.trial.condition}; }},
      {{"trial", ColumnType::kCount}, [](T t) { return std::int64_t{t.trial.trial}; }},
      {{"old"}, [](T t) { return t.trial.of_old; }},
      {{"new"}, [](T t) { return t.trial.of_new; }},
      {{"command"}, [](T t) { return fmt::format("{}", fmt::join(t.commands, "; ")); }}};
  return MakeTable(columns, trials);
}

std::string DescribeChanged(const GateReport& report) {
  const auto num_worse = std::ranges::count(report.changed, true, &ChangedTrial::is_for_worse);
  return fmt::format("{} trials ended otherwise with the new version, {} of them for the worse.",
                     report.changed.size(), num_worse);
}

// Ratios are cut off at e, so a change near e - 1 may be any greater one.
std::string DescribeChange(const GateRow& row) {
  const bool is_cut_off =
      row.test.quantity.scale == GateScale::kRatio && row.interval.upper > 0.97 * (std::numbers::e - 1.0);
  return FormatChange(row) + (is_cut_off ? " or more (each ratio is cut off at e)" : "");
}

std::string ListRows(const GateReport& report, GateVerdict verdict) {
  std::vector<std::string> parts;
  for (const GateRow& row : report.look.rows) {
    if (row.verdict != verdict) continue;
    if (row.n == 0) {
      parts.push_back(row.test.Name());
      continue;
    }
    parts.push_back(
        row.test.is_limit
            ? fmt::format("{} {}, {}", row.test.quantity.name, DescribeChange(row), FormatMargin(row.test))
            : fmt::format("{} {}, margin {}", row.test.Name(), DescribeChange(row), FormatMargin(row.test)));
  }
  return fmt::format("{}", fmt::join(parts, "; "));
}

// The quantities with this verdict of which `is_counted` is true.
std::vector<std::string> ListQuantities(const GateReport& report, GateVerdict verdict,
                                        bool (*is_counted)(const GateRow&)) {
  std::vector<std::string> names;
  for (const GateRow& row : report.look.rows) {
    const std::string& name = row.test.quantity.name;
    if (row.verdict == verdict && is_counted(row) && std::ranges::count(names, name) == 0)
      names.push_back(name);
  }
  return names;
}

// "NAME is not worse than OLD in failure, error by the margins", and of limits "the failure rate of NAME is
// below the limit".
std::string DescribeNotWorse(const GateReport& report) {
  const auto of_limits =
      ListQuantities(report, GateVerdict::kNotWorse, [](const GateRow& row) { return row.test.is_limit; });
  const auto of_margins =
      ListQuantities(report, GateVerdict::kNotWorse, [](const GateRow& row) { return !row.test.is_limit; });
  std::vector<std::string> parts;
  if (!of_margins.empty())
    parts.push_back(fmt::format("{} is not worse than {} in {} by the margins", report.new_label,
                                report.old_label, fmt::join(of_margins, ", ")));
  for (const std::string& name : of_limits)
    parts.push_back(fmt::format("the {} rate of {} is below the limit", name, report.new_label));
  std::string text = fmt::format("{}", fmt::join(parts, ", and "));
  if (text.starts_with("the ")) text[0] = 'T';
  return text;
}

std::string WhyNotMeasured(const GateReport& report) {
  return fmt::format("no trial has it of {}", report.old_label.empty() ? "the version" : "both versions");
}

// "; not judged: error, time": the quantities that the verdict does not cover; empty if it covers all.
std::string ListNotJudged(const GateReport& report) {
  std::vector<std::string> left_out = GateQuantityNames();
  for (const GateRow& row : report.look.rows) std::erase(left_out, row.test.quantity.name);
  const auto not_measured =
      ListQuantities(report, GateVerdict::kNotMeasured, [](const GateRow&) { return true; });
  return (not_measured.empty() ? ""
                               : fmt::format("; not measured, because {}: {}", WhyNotMeasured(report),
                                             fmt::join(not_measured, ", "))) +
         (left_out.empty() ? "" : fmt::format("; not judged: {}", fmt::join(left_out, ", ")));
}

std::string TableLegend(const GateReport& report) {
  if (HasOnlyLimits(report)) {
    return fmt::format(
        "rate: of the new version; its interval holds at every look with probability {:.0f} %, each end with "
        "{:.0f} %. Above the limit: at level {:.0f} % for all {} tests together (Holm). Below the limit: at "
        "level {:.0f} %.",
        100.0 * (1.0 - 2.0 * kGateLevel), 100.0 * (1.0 - kGateLevel), 100.0 * kGateLevel,
        report.look.rows.size(), 100.0 * kGateLevel);
  }
  return fmt::format(
      "{}change: new less old over the pairs, of rates and scores in percentage points; of error and time "
      "the geometric mean of new over old, less 1, each ratio cut off at 1/e and e. An interval of one "
      "quantity holds at every look with probability {:.0f} %, each of its ends with {:.0f} %. Worse: the "
      "change exceeds the margin, at level {:.0f} % for all {} tests together (Holm). Not worse: no change "
      "reaches its margin, at level {:.0f} %.{}",
      report.old_label.empty() ? ""
                               : "old, new: over the pairs, of error and time medians, so that their ratio "
                                 "is not the change. ",
      100.0 * (1.0 - 2.0 * kGateLevel), 100.0 * (1.0 - kGateLevel), 100.0 * kGateLevel,
      report.look.rows.size(), 100.0 * kGateLevel,
      HasSizes(report)
          ? " regions: geometric mean over the pairs of the new regions' size over the old ones'; "
            "wider regions lower miscoverage, and are no merit."
          : "");
}

}  // namespace

std::vector<std::string> ListAssumptions(const ReadableRun& run, const std::vector<GateTest>& tests) {
  const RunDescription& description = run.description;
  std::vector<std::string> assumptions = {
      fmt::format(
          "The verdict is for the mean over these {} conditions, each with the same weight; in quantities of "
          "trials that both versions answer, a condition with many refusals weighs less. In a single "
          "condition a change may be greater.",
          description.conditions.size()),
      "Trials are independent draws of the simulator, and an answer depends on the problem and the stream of "
      "samples alone."};
  const bool has_time =
      std::ranges::any_of(tests, [](const GateTest& test) { return test.quantity.needs_same_run; });
  if (has_time)
    assumptions.push_back(
        "Times: the noise of the machine favours neither version, and is independent from trial to trial.");
  if (description.origin.program.find(',') != std::string::npos ||
      description.origin.instruction_set.find(',') != std::string::npos)
    assumptions.push_back(
        fmt::format("The trials were computed by {} ({}); what is stored of their problems is "
                    "equal in both.",
                    description.origin.program, description.origin.instruction_set));
  return assumptions;
}

std::string GateSentence(const GateReport& report) {
  const GateLook& look = report.look;
  const std::string trials =
      fmt::format("{} trials in each of {} conditions", look.num_rounds, report.num_conditions);
  const std::string against = report.old_label.empty() ? "" : fmt::format(" than {}", report.old_label);
  switch (look.verdict) {
    case GateVerdict::kWorse:
      return fmt::format("{} is worse{} after {}: {}{}.", report.new_label,
                         against.empty() ? " than allowed" : against, trials,
                         ListRows(report, GateVerdict::kWorse), ListNotJudged(report));
    case GateVerdict::kNotWorse:
      return fmt::format("{}, after {}{}.", DescribeNotWorse(report), trials, ListNotJudged(report));
    case GateVerdict::kUndecided:
    case GateVerdict::kNotMeasured:
      break;
  }
  const std::string undecided = ListRows(report, GateVerdict::kUndecided);
  return fmt::format("Undecided whether {} is worse{} after {}, {}{}{}{}.", report.new_label,
                     against.empty() ? " than allowed" : against, trials,
                     report.is_out_of_time ? "when the time was over" : "when no trials were left",
                     undecided.empty() ? "" : ": ", undecided, ListNotJudged(report));
}

std::string ShowCommand(const GateReport& report, const ChangedTrial& trial, bool of_old) {
  return fmt::format("rcme show {} --condition {} --trial {}", of_old ? report.show_old : report.show_new,
                     trial.condition, trial.trial);
}

std::string GateAsText(const GateReport& report) {
  std::string text = FormatParagraph(GateSentence(report)) + "\n" + RenderText(MakePeopleTable(report)) +
                     "\n" + FormatParagraph(TableLegend(report)) + "\n";
  for (const std::string& assumption : report.assumptions) text += FormatParagraph(assumption);
  if (report.old_label.empty()) return text;
  text += "\n" + FormatParagraph(DescribeChanged(report));
  for (const ListedTrial& listed : ListTrials(report, kMaxListed)) {
    text += fmt::format("  {} -> {}:  {}\n", listed.trial.of_old, listed.trial.of_new,
                        fmt::join(listed.commands, "; "));
  }
  return text;
}

std::string GateAsMarkdown(const GateReport& report) {
  std::string text = fmt::format("**{}**\n\n{}\n{}\n\n", GateSentence(report),
                                 RenderMarkdown(MakePeopleTable(report)), TableLegend(report));
  for (const std::string& assumption : report.assumptions) text += fmt::format("- {}\n", assumption);
  if (report.old_label.empty()) return text;
  const std::vector<ListedTrial> trials = ListTrials(report, kMaxListed);
  text += fmt::format("\n{}\n", DescribeChanged(report));
  return trials.empty() ? text : text + "\n" + RenderMarkdown(MakeTrialTable(trials));
}

std::string GateAsJson(const GateReport& report) {
  return JsonText(kGateFormat, {{"study", report.study},
                                {"old", report.old_label},
                                {"new", report.new_label},
                                {"verdict", Name(report.look.verdict)},
                                {"sentence", GateSentence(report)},
                                {"level", kGateLevel},
                                {"trials_per_condition", report.look.num_rounds},
                                {"conditions", report.num_conditions},
                                {"tests", RenderJson(MakeFileTable(report))},
                                {"assumptions", report.assumptions},
                                {"changed_trials",
                                 RenderJson(MakeTrialTable(ListTrials(report, report.changed.size())))}});
}

std::string GateAsJUnit(const GateReport& report) {
  const std::vector<GateRow>& rows = report.look.rows;
  const auto count = [&](GateVerdict verdict) {
    return std::ranges::count(rows, verdict, &GateRow::verdict);
  };
  const std::string name = XmlText("rcme gate " + report.study);
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n<testsuite name=\"{}\" tests=\"{}\" "
      "failures=\"{}\" errors=\"{}\" skipped=\"{}\">\n",
      name, rows.size(), count(GateVerdict::kWorse), count(GateVerdict::kUndecided),
      count(GateVerdict::kNotMeasured));
  for (const GateRow& row : rows) {
    const std::string what =
        XmlText(fmt::format("{}: {} {}, {}{}", Name(row.verdict), row.test.is_limit ? "rate" : "change",
                            FormatChange(row), row.test.is_limit ? "" : "margin ", FormatMargin(row.test)));
    text += fmt::format("<testcase classname=\"{}\" name=\"{}\">", name, XmlText(row.test.Name()));
    if (row.verdict == GateVerdict::kWorse) text += fmt::format("<failure message=\"{}\"/>", what);
    if (row.verdict == GateVerdict::kUndecided) text += fmt::format("<error message=\"{}\"/>", what);
    if (row.verdict == GateVerdict::kNotMeasured)
      text += fmt::format("<skipped message=\"{}\"/>", WhyNotMeasured(report));
    if (row.verdict == GateVerdict::kNotWorse) text += fmt::format("<system-out>{}</system-out>", what);
    text += "</testcase>\n";
  }
  return text + fmt::format("<system-out>{}</system-out>\n</testsuite>\n</testsuites>\n",
                            XmlText(GateSentence(report)));
}

CommandResult MakeGateResult(const GateReport& report) {
  return {GateAsText(report), MakeFileTable(report), GateAsJson(report)};
}

}  // namespace rcme
