#include "experiments/tuning/rate_output.h"

#include <nlohmann/json.hpp>

#include "experiments/core/table/render_table.h"
#include "stats/intervals.h"

namespace rcme {

double ComputeRate(const ErrorCount& count) {
  return static_cast<double>(count.errors) / static_cast<double>(count.n);
}

Estimate EstimateRate(const ErrorCount& count) {
  return {ComputeRate(count), ExactBinomialInterval(count.errors, count.n)};
}

std::string RateForTable(const ErrorCount& count) { return FormatEstimate(EstimateRate(count), kPercent); }

nlohmann::ordered_json RateAsJson(const ErrorCount& count) {
  nlohmann::ordered_json json = RenderJsonBounds(EstimateRate(count));
  json["n"] = count.n;
  return json;
}

}  // namespace rcme
