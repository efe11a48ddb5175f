#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/study_source.h"
#include "experiments/core/table/render_table.h"
#include "experiments/core/text/json_output.h"
#include "experiments/core/text/shell_word.h"
#include "experiments/run/store/new_trials.h"
#include "experiments/run/store/salvage.h"
#include "experiments/statistics/preregistration.h"
#include "experiments/statistics/summarize_counts.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

constexpr size_t kMaxRanges = 8, kMaxConditions = 40;  // printed

struct CheckArguments {
  std::string run, save_good, study, format = "table";
  StudyChanges changes;  // of that study
};

// "3, 17-23, ...": the trials of a condition that are not sound, up to the last known one.
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

// The conditions with trials that are damaged, lost or not run.
Table MakeDamageTable(const RunDescription& run, const std::vector<SalvagedCondition>& conditions) {
  Table table{{Column::Key("condition"),
               Column::Text("sound"),
               Column::Text("counted"),
               {.name = "not_sound", .heading = "damaged, lost or not run"}}};
  for (size_t c = 0; c < conditions.size(); ++c) {
    const SalvagedCondition& condition = conditions[c];
    if (condition.num_sound == condition.num_counted) continue;
    const std::string counted =
        condition.num_counted ? fmt::format("{}", *condition.num_counted) : "not known";
    table.rows.push_back({fmt::format("{}", c), fmt::format("{}", condition.num_sound), counted,
                          NotSoundText(condition, run.conditions[c].num_trials)});
  }
  return table;
}

std::string DamageAsText(Table damage) {
  const size_t num_more = damage.rows.size() - std::min(damage.rows.size(), kMaxConditions);
  damage.rows.resize(damage.rows.size() - num_more);
  if (damage.rows.empty()) return "";
  return RenderText(damage) + (num_more > 0 ? fmt::format("... and {} more conditions\n", num_more) : "");
}

// The report on a file.
struct FileCheck {
  std::string text;                           // for people
  std::string state = "sound", kept = "all";  // kept: trials or counts, as `rcme run --keep` names them
  std::int64_t num_trials = 0;                // that are sound
  TrialOrigin origin;
  std::vector<std::string> findings = {};  // of damage, and of what departs from a lock
  Table damage = {};
};

void PrintCheck(const CheckArguments& arguments, const FileCheck& check) {
  Table row{{Column::Text("file"), Column::Text("state"), Column::Text("kept"), Column::Count("trials"),
             Column::Text("program"), Column::Text("instruction_set")}};
  row.rows.push_back({arguments.run, check.state, check.kept, check.num_trials, check.origin.program,
                      check.origin.instruction_set});
  Table findings{{Column::Text("finding")}};
  for (const std::string& finding : check.findings) findings.rows.push_back({finding});
  PrintResult(
      MakeResult(check.text, kCheckFormat, {}, row, {{"findings", findings}, {"damage", check.damage}}),
      arguments.format);
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

// What the hash of its lock says of the run. True: it departs from the lock without a reason.
bool DescribeLock(const RunDescription& run, const std::string& path, FileCheck* check) {
  if (run.lock.empty()) return false;
  const Preregistration lock = *DescribePreregistered(run, path);
  check->text += fmt::format("{}: locked at {} by {}; the locked text has the SHA-256 {}\n", path,
                             lock.locked_at, lock.program, lock.sha256);
  if (lock.deviations.empty()) check->text += "  the run is as it was locked\n";
  for (const std::string& deviation : lock.deviations) {
    check->text += fmt::format("  not as locked: {}\n", deviation);
    check->findings.push_back("not as locked: " + deviation);
  }
  for (const std::string& reason : lock.reasons) {
    check->text += fmt::format("  reason: {}\n", reason);
    check->findings.push_back("reason: " + reason);
  }
  return !lock.deviations.empty() && lock.reasons.empty();
}

void PrintCheckWithLock(const CheckArguments& arguments, const RunDescription& run, FileCheck check) {
  const bool departs = DescribeLock(run, arguments.run, &check);
  PrintCheck(arguments, check);
  if (departs)
    throw InputError(arguments.run +
                     ": departs from its lock without a reason, which `rcme run` does not allow: the "
                     "file was changed");
}

// The options that name the study of the run, for a command that the user copies.
std::string FormatStudyOptions(const CheckArguments& arguments) {
  if (arguments.study.empty()) return "";
  std::string options = " --study " + QuoteForShell(arguments.study);
  for (const std::string& text : arguments.changes.overrides) options += " --set " + QuoteForShell(text);
  for (const std::string& file : arguments.changes.estimators)
    options += " --add-estimator " + QuoteForShell(file);
  if (arguments.changes.seed >= 0) options += fmt::format(" --seed {}", arguments.changes.seed);
  return options;
}

// The command that saves the sound trials. Without any, the study in the file may be the damaged part.
std::string FormatSaveCommand(const CheckArguments& arguments, std::int64_t num_sound) {
  const bool is_study_lost = num_sound == 0 && arguments.study.empty();
  return fmt::format("rcme check {}{} --save-good NEW.sqlite", QuoteForShell(arguments.run),
                     is_study_lost ? " --study ITS_STUDY.yaml" : FormatStudyOptions(arguments));
}

// Reports, and saves what is asked for; throws InputError if that was nothing.
void ReportDamage(const CheckArguments& arguments) {
  std::optional<Study> study;
  if (!arguments.study.empty()) study = LoadChangedStudy(arguments.study, arguments.changes);
  Salvage salvage(arguments.run, study);
  const std::vector<SalvagedCondition> conditions = arguments.save_good.empty()
                                                        ? salvage.ForEachSoundTrial([](const StoredTrial&) {})
                                                        : SaveGood(&salvage, arguments.save_good);
  FileCheck check;
  check.state = "damaged";
  for (const SalvagedCondition& condition : conditions) check.num_trials += condition.num_sound;
  check.origin = salvage.description().origin;
  check.findings = salvage.findings();
  check.damage = MakeDamageTable(salvage.description(), conditions);
  check.text = fmt::format("{}: damaged; {} trials are sound\n", arguments.run, check.num_trials);
  for (const std::string& finding : check.findings) check.text += fmt::format("  {}\n", finding);
  check.text += DamageAsText(check.damage);
  const std::string save = FormatSaveCommand(arguments, check.num_trials);
  check.text +=
      arguments.save_good.empty()
          ? fmt::format("Next: {}, then rcme run its study with --out NEW.sqlite\n", save)
          : fmt::format("{}: {} trials saved; `rcme run` of the study with --out {} adds the others\n",
                        arguments.save_good, check.num_trials, arguments.save_good);
  PrintCheck(arguments, check);
  if (arguments.save_good.empty())
    throw InputError(fmt::format("{}: is damaged; `{}` saves what is sound", arguments.run, save));
}

void CheckCounts(const CheckArguments& arguments) {
  if (!arguments.save_good.empty())
    throw InputError(
        fmt::format("--save-good: {} holds counts, of which nothing can be saved apart", arguments.run));
  const RunCounts counts = OpenCounts(arguments.run);
  FileCheck check;
  check.kept = "counts";
  check.num_trials = counts.NumTrials();
  check.origin = counts.run.origin;
  check.text = fmt::format("{}: sound: the counts of {} trials\n", arguments.run, check.num_trials);
  PrintCheckWithLock(arguments, counts.run, check);
}

// A sound file is copied, so that a script goes on with the same file in either case.
std::string CopySound(const CheckArguments& arguments) {
  if (arguments.save_good.empty()) return "";
  Salvage salvage(arguments.run, std::nullopt);
  std::int64_t num_saved = 0;
  for (const SalvagedCondition& condition : SaveGood(&salvage, arguments.save_good))
    num_saved += condition.num_sound;
  return fmt::format("{}: all {} trials saved\n", arguments.save_good, num_saved);
}

void CheckTrials(const CheckArguments& arguments) {
  const ResultStore store = ResultStore::OpenForReading(arguments.run);
  store.CheckTrials();
  const RunDescription run = store.Description();
  FileCheck check;
  check.num_trials = store.NumTrials();
  check.origin = run.origin;
  check.text = fmt::format(
      "{}: sound: {} trials, every checksum is right; of {} ({})\n", arguments.run, check.num_trials,
      run.origin.program.empty() ? "a program not noted" : run.origin.program,
      run.origin.instruction_set.empty() ? "instruction set not noted" : run.origin.instruction_set);
  check.text += CopySound(arguments);
  PrintCheckWithLock(arguments, run, check);
}

void CheckFile(const CheckArguments& arguments) {
  if (KeepsCounts(arguments.run)) return CheckCounts(arguments);
  try {
    CheckTrials(arguments);
  } catch (const DamagedFileError&) {
    ReportDamage(arguments);
  } catch (const InputError&) {
    // The run was killed while it wrote: to open its file for reading trials has undone the half of a write.
    if (KeepsCounts(arguments.run)) return CheckCounts(arguments);
    if (arguments.study.empty()) throw;
    ReportDamage(arguments);  // it does not look like a result file, but is said to be one
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
  AddFormatOption(command, &arguments->format);
  command->callback([arguments] { CheckFile(*arguments); });
}

}  // namespace rcme
