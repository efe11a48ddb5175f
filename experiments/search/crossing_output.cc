#include "experiments/search/crossing_output.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "experiments/core/table/render_table.h"
#include "experiments/core/text/columns.h"
#include "experiments/core/text/json_output.h"
#include "experiments/trial/simulate_draw.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

std::vector<ColumnOf<RateCrossing>> CrossingColumns(const CrossingQuestion& question,
                                                    const std::vector<std::string>& factors) {
  std::vector<ColumnOf<RateCrossing>> columns = LevelColumns<RateCrossing>(factors);
  columns.push_back({Column::Key("estimator"), [](const RateCrossing& one) { return one.estimator; }});
  Column estimate = Column::Estimated("estimate");
  estimate.heading = question.setting;
  columns.push_back({estimate, [](const RateCrossing& one) {
                       Estimate crossing{one.estimate, one.interval};
                       const bool is_anywhere =
                           std::isinf(one.interval.lower) && std::isinf(one.interval.upper);
                       if (is_anywhere) crossing.note = "or anywhere";
                       return crossing;
                     }});
  const auto add_interval = [&](const std::string& name, const std::string& json_name,
                                const std::string& heading, Interval RateCrossing::*member) {
    columns.push_back(
        {{.name = name, .type = ColumnType::kInterval, .json_name = json_name, .heading = heading},
         [member](const RateCrossing& one) { return one.*member; }});
  };
  add_interval("lower,upper", "interval", "", &RateCrossing::interval);
  add_interval("logistic_lower,logistic_upper", "logistic_interval", "if logistic",
               &RateCrossing::logistic_interval);
  columns.push_back({Column::Count("trials"), [](const RateCrossing& one) { return one.num_trials(); }});
  columns.push_back({Column::Count("refused"), [](const RateCrossing& one) { return one.num_refused; }});
  return columns;
}

Json EventsAsJson(const std::vector<EventsAtLevel>& events) {
  Json json = Json::array();
  for (const EventsAtLevel& one : events)
    json.push_back({{"level", one.level}, {"events", one.num_events}, {"n", one.num_trials}});
  return json;
}

// A rate without refusals falls again where more and more trials are refused, and then has no one crossing.
std::string WarnOfRefusals(const CrossingQuestion& question, const CrossingAnswer& answer) {
  constexpr double kVisible = 0.02;
  std::set<std::string> refusing;
  for (const RateCrossing& one : answer.crossings) {
    if (static_cast<double>(one.num_refused) > kVisible * static_cast<double>(one.num_trials()))
      refusing.insert(one.estimator);
  }
  if (refusing.empty()) return {};
  return FormatParagraph(fmt::format(
      "Warning: trials were refused ({}), which {} does not count. Where refusals rise with {} that rate may turn, "
      "against what the intervals suppose: ask with --quantity failure_or_refusal as well.",
      fmt::join(refusing, ", "), question.event.name, question.setting));
}

std::string CrossingsAsTable(const Study& study, const CrossingQuestion& question,
                             const CrossingAnswer& answer) {
  std::vector<ColumnOf<RateCrossing>> columns = CrossingColumns(question, answer.factors);
  std::erase_if(columns, [](const auto& one) {  // beside the estimate, or in a warning
    return one.column.name == "lower,upper" || one.column.name == "refused";
  });
  const std::int64_t num_trials = question.num_trials * std::ssize(answer.crossings);
  std::int64_t num_simulated = 0;
  for (const RateCrossing& crossing : answer.crossings) num_simulated += crossing.num_trials();
  return FormatParagraph(fmt::format(
             "Study {}: the value of {} within [{:.6g}, {:.6g}] at which the rate of {} {} {:.6g}",
             study.name, question.setting, question.from, question.to, question.event.name,
             question.is_falling ? "falls below" : "rises above", question.rate)) +
         "\n" + RenderText(MakeTable(columns, answer.crossings)) + "\n" +
         FormatParagraph(fmt::format(
             "Intervals are of 95 % each. The first supposes only that the rate does not {} with {}; the "
             "second also that its log-odds "
             "are linear where the fresh trials were run. inf: the crossing may lie beyond the range; 'or anywhere', or nothing: the trials exclude no place.",
             question.is_falling ? "rise" : "fall", question.setting)) +
         WarnOfRefusals(question, answer) +
         FormatParagraph(DescribeNotSimulated(num_trials - num_simulated, num_trials));
}

std::string CrossingsAsJson(const Study& study, const CrossingQuestion& question,
                            const CrossingAnswer& answer) {
  Json rows = RenderJson(MakeTable(CrossingColumns(question, answer.factors), answer.crossings));
  for (size_t i = 0; i < answer.crossings.size(); ++i) {
    rows[i]["searched"] = EventsAsJson(answer.crossings[i].searched);
    rows[i]["fresh"] = EventsAsJson(answer.crossings[i].fresh);
  }
  return JsonText(kCrossingsFormat, {{"study", study.name},
                                     {"setting", question.setting},
                                     {"from", question.from},
                                     {"to", question.to},
                                     {"logarithmic", question.is_logarithmic},
                                     {"falling", question.is_falling},
                                     {"quantity", question.event.name},
                                     {"rate", question.rate},
                                     {"crossings", rows}});
}

}  // namespace

CommandResult MakeCrossingsResult(const Study& study, const CrossingQuestion& question,
                                  const CrossingAnswer& answer) {
  return {CrossingsAsTable(study, question, answer),
          MakeTable(CrossingColumns(question, answer.factors), answer.crossings),
          CrossingsAsJson(study, question, answer)};
}

}  // namespace rcme
