#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "experiments/commands/commands.h"
#include "experiments/commands/study_source.h"
#include "experiments/core/text/columns.h"
#include "experiments/run/store/new_trials.h"
#include "experiments/run/store/salvage.h"
#include "experiments/statistics/preregistration.h"
#include "experiments/statistics/summarize_counts.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

constexpr size_t kMaxRanges = 8, kMaxConditions = 40;  // printed

struct CheckArguments {
  std::string run, save_good, study;
  StudyChanges changes;  // of that study
};

// "3, 17-23, ...": the trials of a condition that are not sound, to the last that is known of.
std::string NotSoundText(const SalvagedCondition& condition, std::int64_t num_planned) {
  const std::int64_t last = condition.sound.empty() ? 0 : condition.sound.back().end;
  const std::int64_t end = std::max({last, condition.num_counted.value_or(0), num_planned});
  std::vector<std::string> ranges;
  std::int64_t next = 0;
  const auto add_until = [&](std::int64_t first_sound) {
    if (next + 1 == first_sound) ranges.push_back(fmt::format("{}", next));
    if (next + 1 < first_sound) ranges.push_back(fmt::format("{}-{}", next, first_sound - 1));
  };
  for (const TrialRange& range : condition.sound) {
    add_until(range.first);
    next = range.end;
  }
  add_until(end);
  const size_t num_more = ranges.size() - std::min(ranges.size(), kMaxRanges);
  ranges.resize(ranges.size() - num_more);
  return fmt::format("{}{}", fmt::join(ranges, ", "),
                     num_more > 0 ? fmt::format(" and {} more", num_more) : "");
}

std::string DamageAsTable(const RunDescription& run, const std::vector<SalvagedCondition>& conditions) {
  std::vector<std::vector<std::string>> rows = {
      {"condition", "sound", "counted", "damaged, lost or not run"}};
  size_t num_more = 0;
  for (size_t c = 0; c < conditions.size(); ++c) {
    const SalvagedCondition& condition = conditions[c];
    if (condition.num_sound == condition.num_counted) continue;
    num_more += rows.size() > kMaxConditions;
    if (rows.size() > kMaxConditions) continue;
    const std::string counted =
        condition.num_counted ? fmt::format("{}", *condition.num_counted) : "not known";
    rows.push_back({fmt::format("{}", c), fmt::format("{}", condition.num_sound), counted,
                    NotSoundText(condition, run.conditions[c].num_trials)});
  }
  const std::string more = num_more > 0 ? fmt::format("... and {} more conditions\n", num_more) : "";
  return rows.size() > 1 ? FormatColumns(rows) + more : "";
}

std::vector<SalvagedCondition> SaveGood(Salvage* salvage, const std::string& out) {
  if (std::filesystem::exists(out))
    throw InputError(fmt::format("--save-good: {} exists already; give the path of a new file", out));
  NewTrials saved(out, salvage->description());
  std::vector<SalvagedCondition> conditions =
      salvage->ForEachSoundTrial([&](const StoredTrial& trial) { saved.Add(trial); });
  saved.Finish(salvage->description());
  return conditions;
}

void PrintSound(const std::string& run, const ResultStore& store) {
  const TrialOrigin origin = store.Description().origin;
  fmt::print("{}: sound: {} trials, every checksum is right; of {} ({})\n", run, store.NumTrials(),
             origin.program.empty() ? "a program not noted" : origin.program,
             origin.instruction_set.empty() ? "instruction set not noted" : origin.instruction_set);
}

// What the hash of its lock says of the run; throws where the hash is not that of the text.
void PrintLock(const RunDescription& run, const std::string& path) {
  if (run.lock.empty()) return;
  const Preregistration lock = *DescribePreregistered(run, path);
  fmt::print("{}: locked at {} by {}; the locked text has the SHA-256 {}\n", path, lock.locked_at,
             lock.program, lock.sha256);
  if (lock.deviations.empty()) fmt::print("  the run is as it was locked\n");
  for (const std::string& deviation : lock.deviations) fmt::print("  not as locked: {}\n", deviation);
  for (const std::string& reason : lock.reasons) fmt::print("  reason: {}\n", reason);
  if (!lock.deviations.empty() && lock.reasons.empty())
    throw InputError(path +
                     ": departs from its lock without a reason, which `rcme run` does not allow: the "
                     "file was changed");
}

// Reports, and saves what is asked for; throws the error again if that was nothing.
void ReportDamage(const CheckArguments& arguments, const InputError& error) {
  std::optional<Study> study;
  if (!arguments.study.empty()) study = LoadChangedStudy(arguments.study, arguments.changes);
  Salvage salvage(arguments.run, study);
  const std::vector<SalvagedCondition> conditions = arguments.save_good.empty()
                                                        ? salvage.ForEachSoundTrial([](const StoredTrial&) {})
                                                        : SaveGood(&salvage, arguments.save_good);
  std::int64_t num_sound = 0;
  for (const SalvagedCondition& condition : conditions) num_sound += condition.num_sound;
  fmt::print("{}: damaged; {} trials are sound\n", arguments.run, num_sound);
  for (const std::string& finding : salvage.findings()) fmt::print("  {}\n", finding);
  fmt::print("{}", DamageAsTable(salvage.description(), conditions));
  if (arguments.save_good.empty()) {
    const bool is_study_lost = num_sound == 0 && arguments.study.empty();
    fmt::print(
        "Next: rcme check {} --save-good NEW.sqlite{}, then rcme run its study with --out NEW.sqlite\n",
        arguments.run, is_study_lost ? " --study ITS_STUDY.yaml" : "");
    throw error;
  }
  fmt::print("{}: {} trials saved; `rcme run` of the study with --out {} adds the others\n",
             arguments.save_good, num_sound, arguments.save_good);
}

void CheckCounts(const std::string& run) {
  const RunCounts counts = OpenCounts(run);
  fmt::print("{}: sound: the counts of {} trials\n", run, counts.NumTrials());
  PrintLock(counts.run, run);
}

void CheckTrials(const std::string& run) {
  const ResultStore store = ResultStore::OpenForReading(run);
  store.CheckTrials();
  PrintSound(run, store);
  PrintLock(store.Description(), run);
}

void CheckFile(const CheckArguments& arguments) {
  if (KeepsCounts(arguments.run)) return CheckCounts(arguments.run);
  try {
    CheckTrials(arguments.run);
  } catch (const DamagedFileError& error) {
    ReportDamage(arguments, error);
  } catch (const InputError& error) {
    // The run was killed while it wrote: to open its file for reading trials has undone the half of a write.
    if (KeepsCounts(arguments.run)) return CheckCounts(arguments.run);
    if (arguments.study.empty()) throw;
    ReportDamage(arguments, error);  // it does not look like a result file, but is said to be one
  }
}

}  // namespace

void AddCheckCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("check", "Check a result file, list damaged trials, and save the sound ones");
  command->footer(R"(Every command checks the result file that it reads and refuses a damaged one. It checks
the tables and their columns, the type and range of every number, one record per
estimator in every trial, a checksum (CRC-32) per trial, and the number and checksum of
the trials of each condition.

Of a run with a lock (`rcme lock`) it verifies the hash of the locked text, and lists in
what the run departs from it.

This command reads damaged files too and names the damaged trials. --save-good writes
the sound trials to a new file, whole or not at all. `rcme run` then computes the others:
the result is the same as if nothing had been lost.
Exit codes: 0 if the file is sound or its sound trials were saved, 2 if it is damaged.

Examples:
  rcme check run.sqlite
  rcme check run.sqlite --save-good saved.sqlite
  rcme run study.yaml --out saved.sqlite                   computes the lost trials
  rcme check run.sqlite --study study.yaml --save-good saved.sqlite
                                                           the study is damaged too)");
  auto arguments = std::make_shared<CheckArguments>();
  command->add_option("run", arguments->run, "result file of `rcme run`")->required();
  command->add_option("--save-good", arguments->save_good,
                      "write the sound trials of a damaged file to this new file");
  command->add_option("--study", arguments->study,
                      "study file (YAML) of the run, if the study inside the result file is damaged");
  AddStudyOptions(command, &arguments->changes);
  command->callback([arguments] { CheckFile(*arguments); });
}

}  // namespace rcme
