#include "experiments/gate/gate_terms.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <string_view>

#include "experiments/study/command_files.h"
#include "experiments/study/command_permission.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"
#include "parameters/settings.h"
#include "stats/fnv1a.h"

namespace rcme {
namespace {

constexpr const char* kGateRule = "the verdict of a gate is decided: ";
constexpr const char* kBetweenTerms = "; ";

std::string FormatBuild(const std::string& name, const std::string& hash) {
  return fmt::format("build of {} {}", name, hash);
}

// "build of NAME " without the hash.
std::string CutHash(const std::string& build) { return build.substr(0, build.rfind(' ') + 1); }

// "num_iterations 200, not 100" for each option in which the two differ; versions of the program may know
// different options.
std::vector<std::string> ListOtherOptions(const DescribedEstimator& of_old,
                                          const DescribedEstimator& of_new) {
  std::vector<std::string> others;
  for (const auto& [name, value] : of_new.options) {
    const std::optional<std::string> before = FindSetting(of_old.options, name);
    if (before == value) continue;
    others.push_back(fmt::format("{} {}, {}", name, value, before ? "not " + *before : "not known before"));
  }
  for (const auto& [name, value] : of_old.options)
    if (!FindSetting(of_new.options, name)) others.push_back(fmt::format("no {}", name));
  return others;
}

std::string FormatGateTests(const std::vector<GateTest>& tests, const std::string& old_label) {
  std::vector<std::string> parts;
  for (const GateTest& test : tests) parts.push_back(fmt::format("{}={}", test.Name(), test.margin));
  if (!old_label.empty()) parts.push_back("against " + old_label);
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace

GateTerms MakeGateTerms(const std::vector<GateTest>& tests, const std::string& old_label,
                        const std::vector<EstimatorSpec>& versions, const std::string& baseline) {
  GateTerms terms{FormatGateTests(tests, old_label), {FormatBuild("rcme", HashFile("/proc/self/exe"))}};
  for (const EstimatorSpec& version : versions) {
    const std::string command = FindCommand(version);
    if (!command.empty()) terms.builds.push_back(FormatBuild(version.label, HashFilesOfCommand(command)));
  }
  if (!baseline.empty()) {
    Fnv1a hash;
    hash.Add(baseline);
    terms.builds.push_back(
        FormatBuild("the baseline's version " + old_label, fmt::format("{:016x}", hash.value())));
  }
  return terms;
}

RecordedVersion FindRecordedVersion(const RunDescription& run, size_t estimator) {
  return {run.estimators.at(estimator), run.origin, run.stopping_rule};
}

std::string IdentifyVersion(const RecordedVersion& version) {
  std::string text =
      fmt::format("estimator {}\nprogram {} ({})\nstopping rule {}\n", version.estimator.name,
                  version.origin.program, version.origin.instruction_set, version.stopping_rule);
  for (const auto& [name, value] : version.estimator.options) text += fmt::format("{} {}\n", name, value);
  return text;
}

std::string CompareVersions(const RecordedVersion& of_old, const RecordedVersion& of_new) {
  const auto program = [](const RecordedVersion& version) {
    return version.origin.program.empty()
               ? std::string("an unknown program")
               : fmt::format("{} ({})", version.origin.program, version.origin.instruction_set);
  };
  const std::vector<std::string> options = ListOtherOptions(of_old.estimator, of_new.estimator);
  const std::string of_estimator =
      of_old.estimator.name != of_new.estimator.name
          ? fmt::format("another estimator, {}", of_new.estimator.name)
      : options.empty() ? "the same estimator with the same options"
                        : fmt::format("the same estimator with other options ({})", fmt::join(options, ", "));
  return fmt::format("old: {} of {}; new: {}, of {}", of_old.estimator.name, program(of_old), of_estimator,
                     program(of_new));
}

bool HasMisleadingLabel(const RecordedVersion& of_old, const RecordedVersion& of_new) {
  return of_old.estimator.label == of_new.estimator.label &&
         (of_old.estimator.name != of_new.estimator.name ||
          !ListOtherOptions(of_old.estimator, of_new.estimator).empty());
}

std::string GateTerms::AsStoppingRule() const {
  return kGateRule + judged + kBetweenTerms + fmt::format("{}", fmt::join(builds, kBetweenTerms));
}

void RequireSameTerms(const GateTerms& terms, const std::string& stored_rule, const std::string& path) {
  if (stored_rule == terms.AsStoppingRule()) return;
  if (!stored_rule.starts_with(kGateRule)) {
    throw InputError(
        fmt::format("{}: its trials are not those of a gate with known margins. Give another --out or remove "
                    "it",
                    path));
  }
  const std::string stored = stored_rule.substr(std::string_view(kGateRule).size());
  const std::string head = terms.judged + kBetweenTerms;
  if (!stored.starts_with(head + CutHash(terms.builds.front()))) {
    const size_t end = stored.find(kBetweenTerms + CutHash(terms.builds.front()));
    throw InputError(fmt::format(
        "{}: its trials were judged by {}; this call judges by {}. The verdict keeps its 5 % only "
        "if quantities and margins are chosen before the trials are seen. Give another --out",
        path, Quoted(stored.substr(0, end)), Quoted(terms.judged)));
  }
  for (const std::string& build : terms.builds) {
    if ((stored + kBetweenTerms).find(kBetweenTerms + build + kBetweenTerms) != std::string::npos) continue;
    std::string name = CutHash(build).substr(std::string_view("build of ").size());
    name.pop_back();
    throw InputError(fmt::format(
        "the trials in {} are of another build of {}; give another --out or remove it", path, name));
  }
  throw InputError(
      fmt::format("the trials in {} are of other programs; give another --out or remove it", path));
}

}  // namespace rcme
