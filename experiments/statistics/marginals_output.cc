#include "experiments/statistics/marginals_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "experiments/core/table/render_table.h"
#include "experiments/core/text/columns.h"
#include "experiments/core/text/json_output.h"

namespace rcme {
namespace {

using MarginalColumns = std::vector<ColumnOf<Marginal>>;

Column Heading(Column column, const std::string& heading) {
  column.heading = heading;
  return column;
}

// `is_of_these_conditions`: see Marginals.
MarginalColumns ListColumns(bool for_people, bool is_of_these_conditions) {
  MarginalColumns columns = {
      {Column::Key("estimator"), [](const Marginal& one) { return one.estimator; }},
      {Column::Key("regime"), [](const Marginal& one) { return one.regime.empty() ? "all" : one.regime; }},
      {Column::Key("quantity"), [](const Marginal& one) { return Name(one.quantity); }},
      {Column::Estimated("value", kPercent), [for_people](const Marginal& one) {
         return Estimate{.value = one.value,
                         .interval = one.interval,
                         .n = for_people ? std::optional(one.n) : std::nullopt};
       }}};
  if (!for_people)
    columns.push_back({{.name = "lower,upper", .type = ColumnType::kInterval, .json_name = "interval"},
                       [](const Marginal& one) { return one.interval; }});
  columns.push_back({Column::Number("claimed", kPercent), [](const Marginal& one) { return one.claimed; }});
  columns.push_back({Column::Number("sd_over_crb"), [](const Marginal& one) {
                       return std::isnan(one.sd_over_crb) ? Value() : Value(one.sd_over_crb);
                     }});
  if (!for_people)
    columns.push_back({Column::Number("excess"), [](const Marginal& one) { return one.excess; }});
  columns.push_back({Heading(Column::Count("num_conditions"), "conditions"),
                     [](const Marginal& one) { return one.num_conditions; }});
  if (!for_people) {
    columns.push_back({Column::Count("n"), [](const Marginal& one) { return one.n; }});
    columns.push_back({{.name = "interval", .json_name = "interval_kind"}, [=](const Marginal&) {
                         return is_of_these_conditions ? "these_conditions" : "population";
                       }});
  }
  return columns;
}

std::string MarginalsAsTable(const std::string& study, const Marginals& marginals, size_t num_shown) {
  std::vector<Marginal> whole, worst;
  for (const Marginal& one : marginals.rows) {
    if (one.regime.empty())
      whole.push_back(one);
    else if (one.excess > 0.0)
      worst.push_back(one);
  }
  std::ranges::stable_sort(whole, {}, &Marginal::estimator);
  const size_t num_wrong = worst.size();
  worst.resize(std::min(worst.size(), num_shown));
  std::string text =
      FormatParagraph(fmt::format("Study {}: every estimator over all conditions, then the regimes in which "
                                  "it is farthest from what is claimed",
                                  study));
  const MarginalColumns columns = ListColumns(true, marginals.is_of_these_conditions);
  text += "\n" + RenderText(MakeTable(columns, whole)) + "\n";
  text += num_wrong == 0 ? FormatParagraph("In no regime does an interval exclude what is claimed.")
                         : RenderText(MakeTable(columns, worst));
  const char* population =
      marginals.is_of_these_conditions
          ? "(Bonferroni). The conditions are chosen draws, which are no sample of a population: the intervals "
            "hold for these very conditions only."
          : "(Bonferroni), if the conditions are a random sample of a population.";
  text += "\n" +
          FormatParagraph(fmt::format("{} of {} regimes and quantities differ from what is claimed; {} are "
                                      "shown. The {} intervals hold together with {:.0f} % {} "
                                      "sd_over_crb: how sharp the regions of a coverage are, the stated sd "
                                      "over its Cramer-Rao bound (geometric mean).",
                                      num_wrong, marginals.rows.size() - whole.size(), worst.size(),
                                      marginals.num_intervals, 100.0 * marginals.confidence, population));
  return text;
}

}  // namespace

Table MakeMarginalsTable(const Marginals& marginals) {
  return MakeTable(ListColumns(false, marginals.is_of_these_conditions), marginals.rows);
}

CommandResult MakeMarginalsResult(const std::string& study, const Marginals& marginals, size_t num_shown) {
  const Table rows = MakeMarginalsTable(marginals);
  return {MarginalsAsTable(study, marginals, num_shown), rows,
          RenderDocument(kMarginalsFormat,
                         {{"study", study},
                          {"confidence", marginals.confidence},
                          {"num_intervals", static_cast<std::int64_t>(marginals.num_intervals)}},
                         {{"marginals", rows}})};
}

}  // namespace rcme
