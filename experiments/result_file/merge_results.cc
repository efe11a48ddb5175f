#include "experiments/result_file/merge_results.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <tuple>

#include "experiments/base/progress.h"
#include "experiments/base/stop_request.h"
#include "experiments/result_file/first_difference.h"
#include "experiments/result_file/trial_writer.h"
#include "experiments/study/shard.h"
#include "experiments/trial/trial_fields.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

// A part, open to be read: its description is checked, its trials are not yet.
std::unique_ptr<ResultFile> OpenPart(const std::string& path) {
  if (!std::filesystem::is_regular_file(path)) throw InputError(fmt::format("{}: no such result file", path));
  return NamingFile(path, [&] {
    auto part = std::make_unique<ResultFile>(path, SQLite::OPEN_READONLY, FileLocks::kNone);
    part->database.exec("BEGIN");
    part->LoadDescription();
    return part;
  });
}

void CheckSame(const std::string& path, const std::string& first_path, const char* what,
               const std::string& here, const std::string& there) {
  if (here == there) return;
  throw InputError(
      fmt::format("{}: its trials are of {} {}, those of {} of {}: they may differ in their last bits", path,
                  what, here, first_path, there));
}

std::string JoinedNames(const std::string& a, const std::string& b) {
  std::set<std::string> names;
  for (const std::string& list : {a, b}) {
    for (size_t begin = 0; begin < list.size();) {
      const size_t end = std::min(list.find(", ", begin), list.size());
      names.insert(list.substr(begin, end - begin));
      begin = end + 2;
    }
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

// "3/64" -> 64; the whole: 1.
std::uint32_t NumShardsOf(const RunDescription& run) {
  const size_t slash = run.shard.find('/');
  if (slash == std::string::npos) return 1;
  long long count = 0;
  const bool is_number = ParseInteger(run.shard.substr(slash + 1), &count);
  if (!is_number || count < 1 || count > kMaxShards) throw Damage("'shard' of table run is not possible");
  return static_cast<std::uint32_t>(count);
}

// Puts the descriptions of the parts together. What it makes does not depend on their order.
class Descriptions {
 public:
  explicit Descriptions(const MergeOptions& options) : options_(options) {}

  void Add(const ResultFile& part) {
    const RunDescription& run = part.description;
    num_trials_ += part.totals.NumTrials();
    if (first_path_.empty()) {
      first_path_ = part.path;
      merged_ = run;
      num_shards_ = NumShardsOf(run);
      if (part.totals.NumTrials() == 0) merged_.origin = {};
      return;
    }
    if (run.identity != merged_.identity) {
      throw InputError(fmt::format("{}: is of another study than {}; first difference: {}", part.path,
                                   first_path_, FirstDifference(merged_.identity, run.identity)));
    }
    if (run.stopping_rule != merged_.stopping_rule) {
      throw InputError(
          fmt::format("{}: its number of trials was chosen by another rule ('{}') than that of {} "
                      "('{}')",
                      part.path, run.stopping_rule, first_path_, merged_.stopping_rule));
    }
    if (part.totals.NumTrials() > 0) AddOrigin(part);
    if (NumShardsOf(run) != num_shards_) num_shards_ = 0;
    if (run.until_options != merged_.until_options || run.until_trials != merged_.until_trials)
      is_until_known_ = false;
    AddAskedFor(run);
  }

  bool IsEmpty() const { return first_path_.empty(); }
  std::int64_t num_trials() const { return num_trials_; }  // in all parts
  std::uint32_t num_shards() const { return num_shards_; }
  RunDescription Merged() const {
    RunDescription run = merged_;
    if (!is_until_known_) run.until_options.clear();
    return run;
  }

 private:
  void AddOrigin(const ResultFile& part) {
    const TrialOrigin& origin = part.description.origin;
    if (merged_.origin == TrialOrigin()) {
      merged_.origin = origin;
      origin_path_ = part.path;
    }
    const std::string& first = origin_path_.empty() ? first_path_ : origin_path_;
    CheckSame(part.path, first, "program", origin.program, merged_.origin.program);
    if (!options_.are_instruction_sets_mixed)
      CheckSame(part.path, first, "instruction set", origin.instruction_set, merged_.origin.instruction_set);
    merged_.origin.instruction_set = JoinedNames(merged_.origin.instruction_set, origin.instruction_set);
  }

  // The words of the part that asked for most trials, its study's name and description too.
  void AddAskedFor(const RunDescription& run) {
    std::vector<DescribedCondition> conditions = merged_.conditions;
    for (size_t c = 0; c < conditions.size(); ++c)
      conditions[c].num_trials = std::max(conditions[c].num_trials, run.conditions.at(c).num_trials);
    if (std::tie(run.trials, run.study_yaml) > std::tie(merged_.trials, merged_.study_yaml)) {
      const RunDescription before = merged_;
      merged_ = run;
      merged_.until_options = before.until_options;
      merged_.until_trials = before.until_trials;
      merged_.origin = before.origin;
    }
    merged_.conditions = std::move(conditions);
  }

  const MergeOptions options_;
  std::string first_path_, origin_path_;
  RunDescription merged_;
  std::int64_t num_trials_ = 0;
  std::uint32_t num_shards_ = 0;
  bool is_until_known_ = true;
};

Descriptions DescribeParts(const std::vector<std::string>& parts, const MergeOptions& options,
                           std::vector<std::string>* unreadable) {
  Descriptions descriptions(options);
  for (const std::string& path : parts) {
    std::unique_ptr<ResultFile> part;
    try {
      part = OpenPart(path);
    } catch (const InputError& error) {
      if (!unreadable) throw;
      unreadable->push_back(error.what());
      continue;
    }
    NamingFile(path, [&] { descriptions.Add(*part); });
  }
  if (descriptions.IsEmpty())
    throw InputError(fmt::format("no part can be read: {}", fmt::join(*unreadable, "; ")));
  return descriptions;
}

// Calls `visit` for every trial of a part, all of which are checked.
void ReadPart(const std::string& path, const std::string& identity,
              const std::function<void(const StoredTrial&)>& visit) {
  const std::unique_ptr<ResultFile> part = OpenPart(path);
  NamingFile(path, [&] {
    if (part->description.identity != identity) throw Damage("it has been replaced while it was read");
    part->ForEachTrial(std::nullopt, [&](const StoredTrial& trial) {
      if (IsStopRequested()) throw Stopped("stopped; nothing was written");
      visit(trial);
    });
  });
}

// Field by field as text, the time aside; the estimator's number leads.
Settings FieldsOf(const StoredTrial& trial) {
  Settings fields;
  const auto add = [&](const std::string& name, const auto& field) {
    using Field = std::decay_t<decltype(field)>;
    if (name == "seconds") return;
    if constexpr (std::is_same_v<Field, MotionStatus>) {
      fields.emplace_back(name, StatusName(field));
    } else {
      fields.emplace_back(name, fmt::format("{}", field));
    }
  };
  VisitProblemFields(trial.problem, add);
  for (const TrialRecord& record : trial.records) VisitFields(record, add);
  return fields;
}

void CheckEqual(const std::string& path, const StoredTrial& here, const StoredTrial& there) {
  const Settings a = FieldsOf(here), b = FieldsOf(there);
  const auto [in_a, in_b] = std::ranges::mismatch(a, b);
  if (in_a == a.end()) return;
  throw InputError(
      fmt::format("{}: condition {}, trial {} is there twice and not equal: {} is {} here, {} in a part "
                  "before; a trial is a "
                  "function of its study, so one of the two was computed by another program or was changed",
                  path, here.problem.condition, here.problem.trial, in_a->first, in_a->second, in_b->second));
}

// What is missing of the trials asked for, and whose shards' they are.
void NoteMissing(const TrialsHeld& held, const Descriptions& descriptions, MergeReport* report) {
  report->num_trials = held.num_trials();
  report->num_shards = descriptions.num_shards();
  if (!report->run.stopping_rule.empty()) return;
  std::set<std::uint32_t> shards;
  const auto repeats = static_cast<std::uint32_t>(report->run.repeats_per_scene);
  for (std::uint32_t c = 0; c < report->run.conditions.size(); ++c) {
    for (std::uint32_t trial = 0; trial < report->run.conditions[c].num_trials; ++trial) {
      if (held.Has(c, trial)) continue;
      ++report->num_missing;
      if (report->num_shards > 0) shards.insert(ShardOf(c, trial / repeats, report->num_shards));
    }
  }
  report->missing_shards.assign(shards.begin(), shards.end());
}

std::string MergedShard(const MergeReport& report) {
  if (report.num_missing == 0 || report.num_shards <= 1) return "";
  std::vector<std::uint32_t> whole;
  for (std::uint32_t s = 1; s <= report.num_shards; ++s) {
    if (!std::ranges::binary_search(report.missing_shards, s)) whole.push_back(s);
  }
  return fmt::format("{}/{}", whole.empty() ? "none" : ArrayText(whole), report.num_shards);
}

// A result file in the making, beside the place that it takes at Finish; without that nothing is left of it.
class MergedFile {
 public:
  MergedFile(const std::string& out, const RunDescription& run)
      : out_(out), part_(fmt::format("{}.{}.part", out, getpid())) {
    std::filesystem::remove(part_);
    NamingFile(out_, [&] {
      file_.emplace(part_, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, FileLocks::kNone);
      // No other process reads it, and after a crash it is made again.
      file_->database.exec(
          "PRAGMA journal_mode = MEMORY; PRAGMA synchronous = OFF; PRAGMA cache_size = -262144");
      file_->Create(run);
      writer_.emplace(&*file_);
    });
  }
  ~MergedFile() {
    writer_.reset();
    file_.reset();
    std::error_code ignored;
    std::filesystem::remove(part_, ignored);
  }
  MergedFile(const MergedFile&) = delete;
  MergedFile& operator=(const MergedFile&) = delete;

  void Add(const StoredTrial& trial) {
    NamingFile(out_, [&] { writer_->Add({trial.problem}, trial.records); });
  }
  StoredTrial Read(std::uint32_t condition, std::uint32_t trial) const {
    return NamingFile(
        out_, [&] { return ReadStoredTrial(file_->database, file_->Frame(), condition, trial).value(); });
  }
  void Finish(const RunDescription& run) {
    NamingFile(out_, [&] {
      writer_->Commit();
      writer_.reset();
      file_->SetDescription(run);
      file_.reset();
    });
    const int descriptor = open(part_.c_str(), O_RDONLY | O_CLOEXEC);
    const bool is_safe = descriptor >= 0 && fsync(descriptor) == 0;
    if (descriptor >= 0) close(descriptor);
    if (!is_safe || std::rename(part_.c_str(), out_.c_str()) != 0)
      throw InputError(fmt::format("{}: cannot be written: {}", out_, std::strerror(errno)));
  }

 private:
  const std::string out_, part_;
  std::optional<ResultFile> file_;
  std::optional<TrialWriter> writer_;
};

}  // namespace

bool TrialsHeld::Add(std::uint32_t condition, std::uint32_t trial) {
  if (condition >= held_.size()) held_.resize(condition + size_t{1});
  std::vector<bool>& trials = held_[condition];
  if (trial >= trials.size()) trials.resize(std::max<size_t>(trial + size_t{1}, 2 * trials.size()));
  if (trials[trial]) return false;
  trials[trial] = true;
  ++num_trials_;
  return true;
}

void TrialsHeld::AddAll(const TrialsHeld& other) {
  for (std::uint32_t c = 0; c < other.held_.size(); ++c) {
    for (std::uint32_t trial = 0; trial < other.held_[c].size(); ++trial) {
      if (other.held_[c][trial]) Add(c, trial);
    }
  }
}

bool TrialsHeld::Has(std::uint32_t condition, std::uint32_t trial) const {
  return condition < held_.size() && trial < held_[condition].size() && held_[condition][trial];
}

MergeReport MergeResults(const std::vector<std::string>& parts, const std::string& out, bool is_partial,
                         const MergeOptions& options) {
  if (std::filesystem::exists(out)) throw InputError(fmt::format("{}: exists already; give a new file", out));
  const Descriptions descriptions = DescribeParts(parts, options, nullptr);
  MergeReport report;
  report.run = descriptions.Merged();
  Progress progress("trials merged", descriptions.num_trials());
  MergedFile merged(out, report.run);
  TrialsHeld held;
  for (const std::string& path : parts) {
    ReadPart(path, report.run.identity, [&](const StoredTrial& trial) {
      progress.Advance(1);
      if (held.Add(trial.problem.condition, trial.problem.trial)) return merged.Add(trial);
      CheckEqual(path, trial, merged.Read(trial.problem.condition, trial.problem.trial));
      ++report.num_twice;
    });
  }
  NoteMissing(held, descriptions, &report);
  report.run.shard = MergedShard(report);
  if (report.num_missing == 0 || is_partial) merged.Finish(report.run);
  return report;
}

MergeReport CheckParts(const std::vector<std::string>& parts, const MergeOptions& options) {
  MergeReport report;
  const Descriptions descriptions = DescribeParts(parts, options, &report.unreadable);
  report.run = descriptions.Merged();
  TrialsHeld held;
  for (const std::string& path : parts) {
    TrialsHeld of_part;  // none of them count if it is damaged at its end
    try {
      ReadPart(path, report.run.identity,
               [&](const StoredTrial& trial) { of_part.Add(trial.problem.condition, trial.problem.trial); });
      held.AddAll(of_part);
    } catch (const InputError& error) {
      if (std::ranges::count(report.unreadable, error.what()) == 0) report.unreadable.push_back(error.what());
    }
  }
  NoteMissing(held, descriptions, &report);
  return report;
}

}  // namespace rcme
