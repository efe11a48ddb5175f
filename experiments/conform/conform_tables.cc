#include "experiments/conform/conform_tables.h"

#include <algorithm>
#include <cmath>

#include "experiments/statistics/coverage_strata.h"
#include "stats/clustered_estimate.h"
#include "stats/constants.h"
#include "stats/distributions.h"
#include "stats/forecast.h"
#include "stats/median_ratio.h"

namespace rcme {
namespace {

double ComputeRegionSize(const JudgedAnswer& answer, double factor) {
  const double radius = std::sqrt(factor * ChiSquareQuantile(5, answer.level));
  const double size_deg = kDegPerRad * radius * std::exp(answer.row.log_det / 10.0);
  return std::isfinite(factor) ? std::min(size_deg, kWholeSpaceDeg) : kWholeSpaceDeg;
}

RegionKind RegionOfFactor(const std::string& name, const std::function<double(const JudgedAnswer&)>& factor) {
  return {name,
          [factor](const JudgedAnswer& a) { return a.row.nees <= factor(a) * ChiSquareQuantile(5, a.level); },
          [factor](const JudgedAnswer& a) { return ComputeRegionSize(a, factor(a)); }};
}

using Judged = std::vector<JudgedAnswer>;

const NumberFormat kShare{100.0, "%", ".1f", ".2g"};

// The quarter of the answers that is hardest by its visible features: by difficulty, then by the number of
// agreeing matches.
Judged HardestQuarter(Judged judged) {
  const auto hardness = [](const JudgedAnswer& a) {
    const double agreeing = a.row.features[static_cast<size_t>(VisibleFeature::kAgreeing)];
    return std::pair(a.difficulty, std::isnan(agreeing) ? kInfinity : -agreeing);
  };
  std::ranges::stable_sort(
      judged, [&](const JudgedAnswer& a, const JudgedAnswer& b) { return hardness(a) > hardness(b); });
  judged.resize(CountHardest(judged));
  return judged;
}

// As the estimator of a conform file decides: it refuses strange answers too.
bool IsAcceptedInUse(const JudgedAnswer& answer) {
  return answer.verdict.is_accepted && answer.verdict.familiarity > kStrangeLevel;
}

struct AcceptKind {
  std::string name;
  std::function<bool(const JudgedAnswer&)> accepts;
};

struct ProbabilityKind {
  std::string name;
  std::vector<Forecast> forecasts;
};

}  // namespace

std::vector<RegionKind> ListRegionKinds(bool is_check) {
  std::vector<RegionKind> kinds = {RegionOfFactor("stated", [](const JudgedAnswer&) { return 1.0; })};
  if (!is_check) {
    kinds.push_back({"one bound", [](const JudgedAnswer& a) { return a.row.max_error_deg <= a.ball_deg; },
                     [](const JudgedAnswer& a) { return std::min(a.ball_deg, kWholeSpaceDeg); }});
    kinds.push_back(RegionOfFactor("one factor", [](const JudgedAnswer& a) { return a.one_factor; }));
  }
  kinds.push_back(RegionOfFactor("conformed", [](const JudgedAnswer& a) { return a.verdict.factor; }));
  return kinds;
}

Estimate MeasureShare(const Judged& judged, const std::function<bool(const JudgedAnswer&)>& holds,
                      const std::vector<std::int64_t>& more) {
  std::vector<bool> numbers(more.size(), false);
  std::vector<std::int64_t> groups = more;
  for (const JudgedAnswer& answer : judged) {
    numbers.push_back(holds(answer));
    groups.push_back(answer.row.group);
  }
  if (numbers.empty()) return {};
  const ClusteredShare share = MeasureShareOfClusters(numbers, groups);
  return {.value = share.value(), .interval = share.interval};
}

double MeasureMedianSize(const Judged& judged, const RegionKind& kind) {
  std::vector<double> sizes;
  for (const JudgedAnswer& answer : judged) sizes.push_back(kind.size_deg(answer));
  return ComputeMedian(std::move(sizes));
}

size_t CountHardest(const Judged& judged) { return (judged.size() + 3) / 4; }

bool IsAcceptedByRule(const JudgedAnswer& answer) { return answer.verdict.is_accepted; }

Estimate MeasureWrongAndAccepted(const ConformReport& report,
                                 const std::function<bool(const JudgedAnswer&)>& accepts) {
  std::vector<std::int64_t> refused;
  for (const AskedProblem& problem : report.problems)
    if (problem.is_refused) refused.push_back(problem.group);
  return MeasureShare(
      report.judged, [&](const JudgedAnswer& a) { return a.row.is_wrong && accepts(a); }, refused);
}

Table MakeRegionTable(const ConformReport& report) {
  const Judged hardest = HardestQuarter(report.judged);
  const std::vector<ColumnOf<RegionKind>> columns = {
      {Column::Key("region"), [](const RegionKind& kind) { return kind.name; }},
      {Column::Estimated("coverage", kShare),
       [&](const RegionKind& kind) { return MeasureShare(report.judged, kind.covers); }},
      {Column::Estimated("hardest_quarter", kShare),
       [&](const RegionKind& kind) { return MeasureShare(hardest, kind.covers); }},
      {Column::Number("size_deg"),
       [&](const RegionKind& kind) { return MeasureMedianSize(report.judged, kind); }},
      {Column::Number("hardest_deg"),
       [&](const RegionKind& kind) { return MeasureMedianSize(hardest, kind); }},
      {Column::Number("all_motions", kShare), [&](const RegionKind& kind) {
         return MeasureShare(report.judged,
                             [&](const JudgedAnswer& a) { return kind.size_deg(a) >= kWholeSpaceDeg; })
             .value;
       }}};
  return MakeTable(columns, ListRegionKinds(report.is_check));
}

Table MakeAcceptTable(const ConformReport& report) {
  std::vector<AcceptKind> kinds = {{"all", [](const JudgedAnswer&) { return true; }}};
  if (!report.is_check)
    kinds.push_back({"by matches", [](const JudgedAnswer& a) { return a.is_accepted_by_count; }});
  kinds.push_back({"by the rule", IsAcceptedByRule});
  kinds.push_back({"in use", IsAcceptedInUse});
  const auto among = [&](const std::function<bool(const JudgedAnswer&)>& holds) {
    Judged some;
    std::ranges::copy_if(report.judged, std::back_inserter(some), holds);
    return some;
  };
  const std::vector<ColumnOf<AcceptKind>> columns = {
      {Column::Key("accepted"), [](const AcceptKind& kind) { return kind.name; }},
      {Column::Estimated("share", kShare),
       [&](const AcceptKind& kind) { return MeasureShare(report.judged, kind.accepts); }},
      {Column::Estimated("wrong_and_accepted", kShare),
       [&](const AcceptKind& kind) {
         return MeasureShare(report.judged,
                             [&](const JudgedAnswer& a) { return a.row.is_wrong && kind.accepts(a); });
       }},
      {Column::Estimated("wrong_of_problems", kShare),
       [&](const AcceptKind& kind) { return MeasureWrongAndAccepted(report, kind.accepts); }},
      {Column::Estimated("wrong_among_accepted", kShare),
       [&](const AcceptKind& kind) {
         return MeasureShare(among(kind.accepts), [](const JudgedAnswer& a) { return a.row.is_wrong; });
       }},
      {Column::Estimated("accepted_among_right", kShare), [&](const AcceptKind& kind) {
         return MeasureShare(among([](const JudgedAnswer& a) { return !a.row.is_wrong; }), kind.accepts);
       }}};
  return MakeTable(columns, kinds);
}

Table MakeProbabilityTable(const ConformReport& report) {
  ProbabilityKind stated{"stated", {}}, corrected{"corrected", {}};
  bool is_stated = true;
  for (const JudgedAnswer& answer : report.judged) {
    const double log_odds = answer.row.features[static_cast<size_t>(VisibleFeature::kStatedOdds)];
    is_stated = is_stated && (!std::isnan(log_odds) || !std::isfinite(answer.row.max_error_deg));
    const double p = std::isnan(log_odds) ? 1.0 : 1.0 / (1.0 + std::exp(-log_odds));
    stated.forecasts.push_back({p, answer.row.is_wrong, answer.row.group});
    corrected.forecasts.push_back(
        {answer.verdict.failure_probability, answer.row.is_wrong, answer.row.group});
  }
  std::vector<ProbabilityKind> kinds;
  if (is_stated) kinds.push_back(std::move(stated));
  kinds.push_back(std::move(corrected));
  const auto estimate = [](const ClusteredEstimate& e) {
    return Estimate{.value = e.value, .interval = e.interval};
  };
  const std::vector<ColumnOf<ProbabilityKind>> columns = {
      {Column::Key("probability"), [](const ProbabilityKind& kind) { return kind.name; }},
      {Column::Number("mean", kShare),
       [](const ProbabilityKind& kind) {
         double sum = 0.0;
         for (const Forecast& forecast : kind.forecasts) sum += forecast.probability;
         return sum / static_cast<double>(kind.forecasts.size());
       }},
      {Column::Estimated("wrong", kShare),
       [&](const ProbabilityKind& kind) { return estimate(MeasureShareHappened(kind.forecasts)); }},
      {Column::Estimated("brier"),
       [&](const ProbabilityKind& kind) { return estimate(MeasureBrierScore(kind.forecasts)); }},
      {Column::Estimated("log_score"),
       [&](const ProbabilityKind& kind) { return estimate(MeasureLogScore(kind.forecasts)); }}};
  return MakeTable(columns, kinds);
}

}  // namespace rcme
