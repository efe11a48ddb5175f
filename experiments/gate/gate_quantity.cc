#include "experiments/gate/gate_quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/core/text/key_value.h"
#include "experiments/statistics/compared.h"
#include "parameters/input_error.h"
#include "parameters/parameter.h"
#include "parameters/plain_text.h"
#include "parameters/suggestion.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

using GatedNumber = std::function<std::optional<double>(const TrialRecord&, const FailureBounds&)>;

// The number that `rcme compare` uses under this name.
GatedNumber FindNumber(const std::string& compared) { return ComparedByName({compared}).front().of; }

// 1 if the stated 95 % region of an answer does not contain the truth, else 0.
std::optional<double> Miscoverage(const TrialRecord& record, const FailureBounds&) {
  static const double bound = ChiSquareQuantile(5, 0.95);
  if (std::isnan(record.nees)) return std::nullopt;
  return record.nees > bound ? 1.0 : 0.0;
}

std::optional<double> Seconds(const TrialRecord& record, const FailureBounds&) {
  if (!IsCounted(record)) return std::nullopt;
  return record.seconds;
}

}  // namespace

double GateQuantity::Difference(double of_new, double of_old) const {
  if (of_new == of_old) return 0.0;
  if (scale != GateScale::kRatio) return of_new - of_old;
  return std::clamp(std::log(of_new) - std::log(of_old), -1.0, 1.0);
}

double GateQuantity::ToDifference(double margin) const {
  return scale == GateScale::kRatio ? std::log1p(margin) : margin;
}

double GateQuantity::FromDifference(double difference) const {
  return scale == GateScale::kRatio ? std::expm1(difference) : difference;
}

const std::vector<GateQuantity>& GateQuantities() {
  static const std::vector<GateQuantity> all = {
      {"failure", "a motion beyond a failure bound, or an answer that is not valid, of all trials",
       GateScale::kRate, 0.005, false, FindNumber("failure")},
      {"refusal", "no motion, of all trials", GateScale::kRate, 0.005, false, FindNumber("refusal")},
      {"miscoverage", "the stated 95 % region lacks the truth, of trials in which both versions answer",
       GateScale::kRate, 0.01, false, Miscoverage,
       [](const TrialRecord& r) { return r.density.log_det_cov / 10.0; }},
      {"probability",
       "Brier score (P - failed)^2 of the stated P(failure), of trials in which both state one",
       GateScale::kScore, 0.005, false, FindNumber("brier")},
      {"error", "the greater of rotation and direction error, of trials in which both versions answer",
       GateScale::kRatio, 0.05, false, FindNumber("max_error_median_deg_answered")},
      {"time", "processor time of a call", GateScale::kRatio, 0.05, true, Seconds}};
  return all;
}

std::vector<std::string> GateQuantityNames() { return ListNames(GateQuantities()); }

namespace {

void SetMargin(const std::string& text, std::vector<GateTest>* tests) {
  const auto [name, value, has_equals] = SplitKeyValue(text);
  std::vector<std::string> names;
  for (const GateTest& test : *tests) names.push_back(test.quantity.name);
  const auto test = std::ranges::find(names, name);
  if (test == names.end()) {
    throw InputError(fmt::format("--margin: {} is not judged{}; give NAME=MARGIN with a name of: {}",
                                 Quoted(name), DidYouMean(name, names), fmt::join(names, ", ")));
  }
  double margin = 0.0;
  const bool is_number = ParseReal(value, &margin);
  if (!is_number || margin <= 0.0 || margin >= 1.0) {
    throw InputError(
        fmt::format("--margin: {}: {} is not allowed; give a number between 0 and 1", name, Quoted(value)));
  }
  (*tests)[static_cast<size_t>(test - names.begin())].margin = margin;
}

}  // namespace

std::vector<GateTest> MakeGateTests(const std::vector<std::string>& names,
                                    const std::vector<std::string>& margins) {
  std::vector<GateTest> tests;
  for (const GateQuantity& quantity : GateQuantities()) {
    if (std::ranges::count(names, quantity.name) > 0) tests.push_back({quantity, quantity.usual_margin});
  }
  for (const std::string& text : margins) SetMargin(text, &tests);
  return tests;
}

}  // namespace rcme
