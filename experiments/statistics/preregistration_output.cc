#include "experiments/statistics/preregistration_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "experiments/core/text/columns.h"
#include "experiments/core/text/field_text.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

std::string InPerCent(const DecidedHypothesis& decided) {
  if (decided.n == 0) return "-";
  const char* unit = decided.stated.against.empty() ? "%" : "points";
  return fmt::format("{:.2f} {} [{:.2f}, {:.2f}]", 100.0 * decided.value, unit,
                     100.0 * decided.interval.lower, 100.0 * decided.interval.upper);
}

std::string VerdictText(const DecidedHypothesis& decided) {
  return decided.why_open.empty() ? Name(decided.verdict)
                                  : fmt::format("{}: {}", Name(decided.verdict), decided.why_open);
}

// "   ours: stated sd 1.3 times the least possible (median)"; empty: unknown, or of no coverage.
std::string SharpnessLine(const std::string& estimator, const StatedSharpness& sharpness) {
  if (!sharpness.IsKnown()) return "";
  return fmt::format("   {}: {} (median)\n", estimator, DescribeSharpness(sharpness));
}

Json SharpnessAsJson(const StatedSharpness& sharpness) {
  if (!sharpness.IsKnown()) return nullptr;
  return {{"sd_over_crb", JsonNumber(sharpness.sd_over_crb)},
          {"rotation_sd_deg", JsonNumber(sharpness.rotation_sd_deg)},
          {"direction_sd_deg", JsonNumber(sharpness.direction_sd_deg)}};
}

}  // namespace

std::string PreregistrationAsText(const Preregistration& preregistration) {
  std::string text =
      preregistration.is_locked
          ? fmt::format("Decided before the run (locked at {} by {}, SHA-256\n{})\n",
                        preregistration.locked_at, preregistration.program, preregistration.sha256)
          : "Hypotheses of the study. It has no lock (rcme lock): nothing shows that they were\n"
            "written before the run.\n";
  size_t number = 0;
  for (const DecidedHypothesis& decided : preregistration.hypotheses) {
    text += "\n" + FormatParagraph(fmt::format("{}. {}", ++number, Describe(decided.stated)));
    text += fmt::format("   {}; {}, n = {}\n", VerdictText(decided), InPerCent(decided), decided.n);
    text += SharpnessLine(decided.stated.estimator, decided.sharpness) +
            SharpnessLine(decided.stated.against, decided.sharpness_against);
  }
  const bool is_measured = std::ranges::any_of(
      preregistration.hypotheses, [](const DecidedHypothesis& decided) { return decided.n > 0; });
  if (is_measured) {
    text += fmt::format(
        "\nAll {} intervals together hold with {:.0f} %, each with {:.2f} %. They are of the\n"
        "trials that were asked for beforehand.\n",
        number, 100.0 * preregistration.confidence, 100.0 * preregistration.confidence_each);
  } else if (preregistration.is_locked && number == 0) {
    text += "It states no hypothesis.\n";
  }
  if (!preregistration.deviations.empty()) text += "\nDecided after: the run departs from its lock\n";
  for (const std::string& deviation : preregistration.deviations) text += fmt::format("  {}\n", deviation);
  for (const std::string& reason : preregistration.reasons) text += fmt::format("  reason: {}\n", reason);
  return text + "\nAll else in this summary was not decided before the run: it explores.\n";
}

Json PreregistrationAsJson(const Preregistration& preregistration) {
  Json hypotheses = Json::array();
  for (const DecidedHypothesis& decided : preregistration.hypotheses) {
    hypotheses.push_back({{"hypothesis", Describe(decided.stated)},
                          {"quantity", decided.stated.quantity},
                          {"estimator", decided.stated.estimator},
                          {"against", decided.stated.against},
                          {"value", decided.value},
                          {"interval", {decided.interval.lower, decided.interval.upper}},
                          {"n", decided.n},
                          {"conditions", decided.num_conditions},
                          {"sharpness", SharpnessAsJson(decided.sharpness)},
                          {"sharpness_against", SharpnessAsJson(decided.sharpness_against)},
                          {"verdict", Name(decided.verdict)},
                          {"why_open", decided.why_open}});
  }
  return {{"locked", preregistration.is_locked},
          {"locked_at", preregistration.locked_at},
          {"program", preregistration.program},
          {"sha256", preregistration.sha256},
          {"confidence", preregistration.confidence},
          {"confidence_each", preregistration.confidence_each},
          {"deviations", preregistration.deviations},
          {"reasons", preregistration.reasons},
          {"hypotheses", hypotheses}};
}

}  // namespace rcme
