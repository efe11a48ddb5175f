#include "experiments/conform/conform_strata.h"

#include <cmath>

#include "experiments/conform/conform_tables.h"
#include "stats/constants.h"

namespace rcme {
namespace {

double FromLogOdds(double x) { return 1.0 / (1.0 + std::exp(-x)); }
double FromLogRad(double x) { return kDegPerRad * std::exp(x); }

struct StratifiedFeature {
  const char* name;
  VisibleFeature feature;
  double (*to_own_units)(double);
};

constexpr StratifiedFeature kFeatures[] = {
    {"matches", VisibleFeature::kMatches, [](double x) { return std::expm1(x); }},
    {"agreeing", VisibleFeature::kAgreeing, [](double x) { return std::expm1(x); }},
    {"parallax_over_noise", VisibleFeature::kParallax, [](double x) { return std::exp(x); }},
    {"planarity", VisibleFeature::kPlanarity, FromLogOdds},
    {"rotation_sd_deg", VisibleFeature::kRotationSd, FromLogRad},
    {"direction_sd_deg", VisibleFeature::kDirectionSd, FromLogRad},
    {"failure_probability", VisibleFeature::kStatedOdds, FromLogOdds}};

VisibleAnswers CollectAnswers(const ConformReport& report, const RegionKind& kind) {
  VisibleAnswers answers;
  answers.label = kind.name;
  answers.level = report.rule.level;
  answers.sharpness_names = {"size_deg"};
  answers.sharpness.resize(1);
  for (const JudgedAnswer& answer : report.judged) {
    answers.clusters.push_back(answer.row.group);
    answers.are_covered.push_back(kind.covers(answer));
    answers.sharpness[0].push_back(kind.size_deg(answer));
  }
  for (const StratifiedFeature& feature : kFeatures) {
    answers.seen_names.emplace_back(feature.name);
    std::vector<double>& values = answers.seen.emplace_back();
    for (const JudgedAnswer& answer : report.judged)
      values.push_back(feature.to_own_units(answer.row.features[static_cast<size_t>(feature.feature)]));
  }
  return answers;
}

}  // namespace

std::vector<CoverageStratum> MeasureConformStrata(const ConformReport& report) {
  std::vector<CoverageStratum> strata;
  for (const RegionKind& kind : ListRegionKinds(/*is_check=*/true)) {  // stated and conformed alone
    for (CoverageStratum& stratum :
         MeasureCoverageStrata(CollectAnswers(report, kind), StrataIntervals::kClusters))
      strata.push_back(std::move(stratum));
  }
  return strata;
}

}  // namespace rcme
