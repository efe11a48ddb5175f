#include "experiments/study/command_permission.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "estimator/conform/conform_estimator.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"
#include "parameters/settings.h"

namespace rcme {
namespace {

// The names of peers/outside_estimators.cc.
constexpr const char *kProcess = "process", *kCommand = "command", *kNoCommand = "none",
                     *kConformFile = "file";

constexpr size_t kMaxCommandBytes = 2000;  // short enough for a message to show all of it

// The whole command; characters that a terminal would not show as they are become escapes.
std::string ShownCommand(const std::string& command) {
  return fmt::format("'{}'", Printable(command, kMaxCommandBytes));
}

}  // namespace

std::string FindCommand(const EstimatorSpec& spec) {
  if (const std::optional<EstimatorSpec> inner = FindConformed(spec)) return FindCommand(*inner);
  if (spec.name != kProcess) return {};
  const std::string command = FindSetting(spec.options, kCommand).value_or(kNoCommand);
  return command == kNoCommand ? std::string() : command;
}

bool IsCommand(const EstimatorSpec& spec, const std::string& option) {
  return (spec.name == kProcess && option == kCommand) ||
         (spec.name == kConformEstimator && option == kConformFile);
}

void NoteCommandPlace(const std::string& place, EstimatorSpec* spec) {
  const std::string command = FindCommand(*spec);
  if (command.empty()) return;
  if (command.size() > kMaxCommandBytes) {
    throw InputError(fmt::format("command: {} is too long; at most {} bytes are allowed: write a script",
                                 Quoted(command), kMaxCommandBytes));
  }
  spec->command_place = place;
}

void SetOwnOptions(EstimatorSpec* spec, const Settings& options) {
  SetOptions(spec, options);
  for (const auto& [option, value] : options) {
    if (IsCommand(*spec, option)) spec->command_place.clear();
    if (spec->name != kConformEstimator || option != kConformFile) continue;
    // With the digest, so that the file cannot be exchanged unnoticed.
    SetOptions(spec, ConformOptions(value));
    NoteCommandPlace(value, spec);  // a command in the file still needs permission
  }
}

void RequireAllowedCommands(const std::vector<EstimatorSpec>& estimators) {
  std::vector<std::string> refused;
  for (const EstimatorSpec& spec : estimators) {
    if (spec.command_place.empty()) continue;
    refused.push_back(fmt::format("{} of estimator {} ({})", ShownCommand(FindCommand(spec)),
                                  Quoted(spec.label), spec.command_place));
  }
  if (refused.empty()) return;
  throw InputError(
      fmt::format("a command in a file does not run unless you allow it: {}; read it, then add "
                  "--allow-process (in Python: allow_process=True)",
                  fmt::join(refused, ", ")));
}

std::vector<std::string> AllowCommands(std::vector<EstimatorSpec>* estimators) {
  std::vector<std::string> sentences;
  for (EstimatorSpec& spec : *estimators) {
    if (spec.command_place.empty()) continue;
    sentences.push_back(fmt::format("estimator {} runs the command {} ({})", Quoted(spec.label),
                                    ShownCommand(FindCommand(spec)), spec.command_place));
    spec.command_place.clear();
  }
  return sentences;
}

}  // namespace rcme
