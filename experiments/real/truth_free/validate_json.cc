#include "experiments/real/truth_free/validate_json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

#include "experiments/real/truth_free/closure_output.h"
#include "experiments/real/truth_free/validate_words.h"

namespace rcme {
namespace {

// A part of a set: a test, a fault, ...
template <typename Part>
struct PartOfSet {
  const SetReport* set;
  const Part* part;
};
template <typename Part>
using PartColumns = std::vector<ColumnOf<PartOfSet<Part>>>;

// A row for each part of each set, after a column for the set.
template <typename Part, typename ListParts>
Table MakeTableOfParts(PartColumns<Part> columns, const std::vector<SetReport>& reports,
                       ListParts list_parts) {
  columns.insert(columns.begin(), {Column::Key("set"), [](const auto& row) { return row.set->name; }});
  std::vector<PartOfSet<Part>> rows;
  for (const SetReport& report : reports) {
    for (const Part& part : list_parts(report)) rows.push_back({&report, &part});
  }
  return MakeTable(columns, rows);
}

Column MakeIntervalColumn(const std::string& name) {
  return {.name = name + "_lower," + name + "_upper",
          .type = ColumnType::kInterval,
          .json_name = name + "_interval"};
}

// The parameter, its interval, and as how many pairs it counts.
void AddPooled(const std::string& name, PooledParameter FaultReport::*member,
               PartColumns<FaultReport>* columns) {
  using F = const PartOfSet<FaultReport>&;
  columns->push_back({Column::Number(name), [=](F f) { return (f.part->*member).value; }});
  columns->push_back({MakeIntervalColumn(name), [=](F f) { return (f.part->*member).interval; }});
  columns->push_back(
      {Column::Number(name + "_effective_pairs"), [=](F f) { return (f.part->*member).effective_n; }});
}

void AddRatio(const std::string& name, ComparedMedians TruthFreeTest::*member,
              PartColumns<TruthFreeTest>* columns) {
  using T = const PartOfSet<TruthFreeTest>&;
  columns->push_back({Column::Number(name), [=](T t) { return (t.part->*member).value; }});
  columns->push_back({MakeIntervalColumn(name), [=](T t) { return (t.part->*member).interval; }});
}

void AddCoverage(const std::string& name, SharedMemberRate TruthFreeTest::*member,
                 PartColumns<TruthFreeTest>* columns) {
  using T = const PartOfSet<TruthFreeTest>&;
  columns->push_back({Column::Number(name), [=](T t) { return (t.part->*member).rate; }});
  columns->push_back({MakeIntervalColumn(name), [=](T t) { return (t.part->*member).interval; }});
}

std::vector<ColumnOf<SetReport>> MakeSetColumns() {
  using S = const SetReport&;
  return {
      {Column::Key("set"), [](S s) { return s.name; }},
      {Column::Count("pairs"), [](S s) { return s.num_pairs; }},
      {Column::Count("answered"), [](S s) { return s.num_answered; }},
      {Column::Text("covariances"), [](S s) { return VerdictName(s.covariances.verdict); }},
      {Column::Text("cause"), [](S s) { return CauseName(s.covariances.cause); }},
      {Column::Text("by_tests"), [](S s) { return fmt::format("{}", fmt::join(s.covariances.tests, " ")); }},
      {Column::Number("rotation_sd_deg"), [](S s) { return s.rotation_sd_deg; }},
      {Column::Number("direction_sd_deg"), [](S s) { return s.direction_sd_deg; }},
      {Column::Number("assumed_sigma_px"), [](S s) { return s.assumed_sigma_px; }},
      {Column::Number("sigma_px"), [](S s) { return s.sigma_px.value; }},
      {MakeIntervalColumn("sigma_px"), [](S s) { return s.sigma_px.interval; }},
      {Column::Text("sigma_verdict"), [](S s) { return VerdictName(s.sigma_verdict); }},
      {Column::Count("calibration_pairs"), [](S s) { return s.calibration.num_pairs; }},
      {Column::Number("calibration_p_value"), [](S s) { return s.calibration.p_value; }},
      {Column::Number("calibration_dispersion"), [](S s) { return s.calibration.dispersion; }},
      {Column::Text("calibration_verdict"), [](S s) { return FaultVerdict(s.calibration.verdict); }},
      {Column::Count("size_pairs"), [](S s) { return s.sizes.num_pairs; }},
      {Column::Number("size_slope"), [](S s) { return s.sizes.slope.value; }},
      {MakeIntervalColumn("size_slope"), [](S s) { return s.sizes.slope.interval; }},
      {Column::Number("size_slope_effective_pairs"), [](S s) { return s.sizes.slope.effective_n; }},
      {Column::Text("size_verdict"), [](S s) { return VerdictName(s.sizes.verdict); }}};
}

using LoopCount = std::pair<const size_t, int>;  // images, loops of so many
PartColumns<LoopCount> MakeLoopColumns() {
  using L = const PartOfSet<LoopCount>&;
  return {{Column::Count("images"), [](L l) { return static_cast<std::int64_t>(l.part->first); }},
          {Column::Count("loops"), [](L l) { return l.part->second; }}};
}

PartColumns<TruthFreeTest> MakeTestColumns() {
  using T = const PartOfSet<TruthFreeTest>&;
  PartColumns<TruthFreeTest> columns = {
      {Column::Key("test"), [](T t) { return t.part->name; }},
      {Column::Count("degrees_of_freedom"), [](T t) { return t.part->degrees_of_freedom; }},
      {Column::Count("n"), [](T t) { return t.part->num_values; }}};
  AddCoverage("coverage", &TruthFreeTest::coverage, &columns);
  AddCoverage("twin_coverage", &TruthFreeTest::twin_coverage, &columns);
  AddRatio("ratio", &TruthFreeTest::ratio, &columns);
  AddRatio("in_simulation", &TruthFreeTest::in_simulation, &columns);
  AddRatio("against_twins", &TruthFreeTest::against_twins, &columns);
  columns.push_back({Column::Text("verdict"), [](T t) { return VerdictName(t.part->verdict); }});
  columns.push_back({Column::Text("cause"), [](T t) { return CauseName(t.part->cause); }});
  columns.push_back({Column::Count("units"), [](T t) { return t.part->num_units; }});
  columns.push_back({Column::Number("units_needed"), [](T t) { return t.part->units_needed; }});
  return columns;
}

PartColumns<DistanceCorrelation> MakeCorrelationColumns() {
  using C = const PartOfSet<DistanceCorrelation>&;
  return {{Column::Number("from_px"), [](C c) { return c.part->from_px; }},
          {Column::Number("to_px"), [](C c) { return c.part->to_px; }},
          {Column::Number("n"), [](C c) { return c.part->num_products; }},
          {Column::Number("correlation"), [](C c) { return c.part->correlation; }},
          {Column::Number("twin_correlation"), [](C c) { return c.part->twin_correlation; }},
          {MakeIntervalColumn("difference"), [](C c) { return c.part->difference; }},
          {Column::Text("verdict"), [](C c) { return CorrelationVerdict(*c.part); }}};
}

PartColumns<FaultReport> MakeFaultColumns() {
  using F = const PartOfSet<FaultReport>&;
  PartColumns<FaultReport> columns = {
      {Column::Key("fault"), [](F f) { return FindFaultText(f.part->fault).name; }},
      {Column::Number("nominal"), [](F f) { return FindFaultText(f.part->fault).nominal; }}};
  AddPooled("beside_others", &FaultReport::joint, &columns);
  AddPooled("alone", &FaultReport::alone, &columns);
  AddPooled("twins", &FaultReport::twins, &columns);
  columns.push_back({Column::Text("verdict"), [](F f) { return FaultVerdict(f.part->verdict); }});
  columns.push_back({Column::Text("in_words"), [](F f) { return DescribeFault(*f.part); }});
  return columns;
}

PartColumns<std::string> MakeAdviceColumns() {
  return {{Column::Text("advice"), [](const PartOfSet<std::string>& a) { return *a.part; }}};
}

}  // namespace

std::vector<NamedTable> MakeValidationParts(const std::vector<SetReport>& reports) {
  return {{"sets", MakeTable(MakeSetColumns(), reports)},
          {"loops", MakeTableOfParts(
                        MakeLoopColumns(), reports,
                        [](const SetReport& set) -> const auto& { return set.num_loops; })},
          {"tests",
           MakeTableOfParts(
               MakeTestColumns(), reports, [](const SetReport& set) -> const auto& { return set.tests; })},
          {"correlations", MakeTableOfParts(
                               MakeCorrelationColumns(), reports,
                               [](const SetReport& set) -> const auto& { return set.correlations; })},
          {"closures", MakeClosureTable(reports)},
          {"camera_faults", MakeTableOfParts(
                                MakeFaultColumns(), reports,
                                [](const SetReport& set) -> const auto& { return set.calibration.faults; })},
          {"advice", MakeTableOfParts(
                         MakeAdviceColumns(), reports,
                         [](const SetReport& set) -> const auto& { return set.advice; })}};
}

}  // namespace rcme
