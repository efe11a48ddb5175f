#include "experiments/statistics/compared.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "experiments/core/text/pick_name.h"
#include "experiments/statistics/failure_forecasts.h"
#include "experiments/trial/trial_event.h"
#include "experiments/trial/trial_measure.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"

namespace rcme {
namespace {

Compared Event(const TrialEvent& event) {
  return {ComparedKind::kEvent, event.name, event.doc,
          [event](const TrialRecord& record, const FailureBounds& bounds) -> std::optional<double> {
            if (!event.IsKnownFor(record)) return std::nullopt;
            return event.has_happened(record, bounds) ? 1.0 : 0.0;
          }};
}

Compared Measure(ComparedKind kind, const TrialMeasure& measure) {
  return {kind, measure.name, measure.doc + ", of " + measure.base,
          [measure](const TrialRecord& record, const FailureBounds&) { return measure.Of(record); }};
}

std::optional<double> KnownNumber(double number) {
  return std::isnan(number) ? std::nullopt : std::optional<double>(number);
}

// Less is better, unlike for the accuracy scores.
Compared Brier() {
  return {ComparedKind::kScore, "brier",
          "Brier score (P - y)^2 of the stated probability of failure, 0 best; of answers that have one",
          BrierOfStated};
}

// Proper scores of the stated density. They have no upper bound, so they are compared like errors.
std::vector<Compared> DensityScores() {
  return {
      {ComparedKind::kError, "energy_score_deg",
       "energy score of the stated density, 0 best; of answers that have a covariance",
       [](const TrialRecord& record, const FailureBounds&) {
         return KnownNumber(record.density.energy_score_deg);
       }},
      {ComparedKind::kError, "log_score",
       "logarithmic score of the stated density (nats), less is better; of answers whose covariance is "
       "not singular",
       [](const TrialRecord& record, const FailureBounds&) { return KnownNumber(record.density.log_score); },
       "nats"}};
}

bool IsNamed(const Compared& compared, const std::string& name) {
  return name == compared.name || name == Name(compared.kind) + "s";
}

}  // namespace

std::string Name(ComparedKind kind) { return PickName(kind, {"event", "score", "error"}); }

const std::vector<Compared>& AllCompared() {
  static const std::vector<Compared> all = [] {
    std::vector<Compared> compared;
    for (const TrialEvent& event : TrialEvents()) compared.push_back(Event(event));
    for (const TrialMeasure& score : TrialScores()) compared.push_back(Measure(ComparedKind::kScore, score));
    compared.push_back(Brier());
    for (const TrialMeasure& error : TrialErrors()) compared.push_back(Measure(ComparedKind::kError, error));
    for (const Compared& score : DensityScores()) compared.push_back(score);
    return compared;
  }();
  return all;
}

std::vector<Compared> ComparedByName(const std::vector<std::string>& names) {
  const std::vector<Compared>& all = AllCompared();
  const auto fail = [&](const std::string& what) {
    std::vector<std::string> allowed = {"events", "scores", "errors"};
    for (const Compared& compared : all) allowed.push_back(compared.name);
    throw InputError(fmt::format("--of: {}; allowed: {}", what, fmt::join(allowed, ", ")));
  };
  for (const std::string& name : names) {
    if (std::ranges::none_of(all, [&](const Compared& compared) { return IsNamed(compared, name); }))
      fail(fmt::format("{} cannot be compared", Quoted(name)));
  }
  std::vector<Compared> chosen;
  for (const Compared& compared : all) {
    if (std::ranges::any_of(names, [&](const std::string& name) { return IsNamed(compared, name); }))
      chosen.push_back(compared);
  }
  if (chosen.empty()) fail("nothing is named");
  return chosen;
}

}  // namespace rcme
