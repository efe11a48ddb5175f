#include "experiments/tuning/rate_output.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "stats/intervals.h"

namespace rcme {

double RateOf(const ErrorCount& count) {
  return static_cast<double>(count.errors) / static_cast<double>(count.n);
}

std::string RateForTable(const ErrorCount& count) {
  if (count.n == 0) return "-";
  const Interval interval = ExactBinomialInterval(count.errors, count.n);
  return fmt::format("{:.2f} % [{:.2f}, {:.2f}]", 100.0 * RateOf(count), 100.0 * interval.lower,
                     100.0 * interval.upper);
}

nlohmann::ordered_json RateAsJson(const ErrorCount& count) {
  const Interval interval = ExactBinomialInterval(count.errors, count.n);
  return {{"value", count.n > 0 ? nlohmann::ordered_json(RateOf(count)) : nullptr},
          {"lower", interval.lower},
          {"upper", interval.upper},
          {"n", count.n}};
}

}  // namespace rcme
