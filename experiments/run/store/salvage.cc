#include "experiments/run/store/salvage.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>

#include "experiments/core/files/checksum.h"
#include "experiments/core/text/shell_word.h"
#include "experiments/run/store/schema.h"
#include "experiments/study/study_file.h"

namespace rcme {
namespace {

constexpr std::int64_t kEnd = std::int64_t{1} << 32;  // beyond the last possible trial
constexpr size_t kMaxFindings = 5;

// Returns whether `action` ends without damage; `note` gets a message about the damage.
template <typename Action, typename Note>
bool IsUndamaged(Action action, Note note) {
  try {
    action();
    return true;
  } catch (const SQLite::Exception& error) {
    note(error.what());
  } catch (const Damage& damage) {
    note(damage.what());
  }
  return false;
}

// Calls `visit` for at most `limit` trials of a condition in [first, end) in the table of problems,
// ascending or descending ("ASC", "DESC"). Returns false if damage ended it.
bool Scan(const SQLite::Database& database, std::uint32_t condition, std::int64_t first, std::int64_t end,
          const char* direction, std::int64_t limit, const std::function<void(std::int64_t)>& visit) {
  const auto scan = [&] {
    SQLite::Statement query(database,
                            fmt::format("SELECT trial FROM problems WHERE condition = ? AND trial >= "
                                        "? AND trial < ? ORDER BY trial {} LIMIT ?",
                                        direction));
    SQLite::bind(query, condition, first, end, limit);
    std::int64_t low = first, high = end;  // range not yet visited
    while (query.executeStep()) {
      const std::int64_t trial = IntegerIn(query.getColumn(0), "problems");
      if (trial < low || trial >= high) throw Damage("out of order");
      (*direction == 'A' ? low : high) = *direction == 'A' ? trial + 1 : trial;
      visit(trial);
    }
  };
  return IsUndamaged(scan, [](const char*) {});
}

// Returns the first trial at or after `first`, or kEnd if there is none; nothing if damage is in the way.
std::optional<std::int64_t> FirstFrom(const SQLite::Database& database, std::uint32_t condition,
                                      std::int64_t first) {
  std::int64_t found = kEnd;
  const bool is_undamaged =
      Scan(database, condition, first, kEnd, "ASC", 1, [&](std::int64_t trial) { found = trial; });
  return is_undamaged ? std::optional(found) : std::nullopt;
}

// Calls `visit` for every trial of a condition that can be reached through the table of problems, ascending.
// Behind a damaged place, the next readable trial is found in growing steps, and the trials between are read
// backwards.
void ForEachReachable(const SQLite::Database& database, std::uint32_t condition,
                      const std::function<void(std::int64_t)>& visit) {
  std::int64_t next = 0;
  const auto visit_next = [&](std::int64_t trial) {
    next = trial + 1;
    visit(trial);
  };
  while (next < kEnd && !Scan(database, condition, next, kEnd, "ASC", -1, visit_next)) {
    std::optional<std::int64_t> behind;
    for (std::int64_t step = 1; !behind && next + step < kEnd; step *= 2) {
      behind = FirstFrom(database, condition, next + step);
    }
    std::vector<std::int64_t> between;
    Scan(database, condition, next, behind.value_or(kEnd), "DESC", -1,
         [&](std::int64_t trial) { between.push_back(trial); });
    for (auto trial = between.rbegin(); trial != between.rend(); ++trial) visit(*trial);
    next = behind.value_or(kEnd);
  }
}

// Runs `action`, without which nothing can be recovered.
template <typename Action>
void NamingLostFile(const std::string& path, bool has_study, Action action) {
  std::string what;
  try {
    return action();
  } catch (const SQLite::Exception& error) {
    if (error.getErrorCode() != SQLITE_CORRUPT) ThrowForFile(path, error);
    what = error.what();
  } catch (const Damage& damage) {
    what = damage.what();
  }
  throw DamagedFileError(fmt::format(
      "{}: is damaged: {}; no trial can be saved from it{}; run its study again with another --out", path,
      what, has_study ? "" : " (if its study alone is lost, give that with --study)"));
}

// Reads the study in a file whose description is damaged. Its lines are of no use to the reader, who has no
// such file to correct.
Study ReadStoredStudy(SQLite::Database& database, const std::string& path) {
  const std::string text = UncheckedRunValue(database, "study");
  try {
    return ParseStudy(text, path + " (its study)");
  } catch (const InputError&) {
    throw DamagedFileError(
        fmt::format("{}: is damaged: the study stored in it cannot be read; `rcme check {} --study "
                    "STUDY.yaml` reads the trials with the study's own file",
                    path, QuoteForShell(path)));
  }
}

void Append(std::uint32_t trial, std::vector<TrialRange>* ranges) {
  if (!ranges->empty() && ranges->back().end == trial) {
    ++ranges->back().end;
  } else {
    ranges->push_back({trial, trial + 1});
  }
}

}  // namespace

Salvage::Salvage(const std::string& path, const std::optional<Study>& study)
    : file_(path, SQLite::OPEN_READWRITE) {
  const auto note = [&](const char* what) { Note(what); };
  std::optional<RunDescription> stored;
  NamingLostFile(path, study.has_value(), [&] {
    file_.database.exec("BEGIN");
    CheckTables(file_.database, {"problems", "trials"});
    if (!study) CheckFormat(file_.database, path);
    stored = ReadStored();
    description_ = study    ? Describe(MakePlan(*study, path, PlanEstimators::kNotMade))
                   : stored ? *stored
                            : DescribeStudy();
  });
  if (study && stored) {
    if (stored->identity != description_.identity) Note("the study is another than that of the file");
    description_.stopping_rule = stored->stopping_rule;
    description_.shard = stored->shard;
    description_.lock = stored->lock;
    description_.despite_lock = stored->despite_lock;
    description_.origin = stored->origin;
  }
  if (!stored) {
    description_.origin = {"not known", "not known"};
    std::optional<std::string> rule;
    IsUndamaged([&] { rule = SoundStoppingRule(file_.database, description_.identity); }, note);
    description_.stopping_rule = rule.value_or("not known: that part of the file was damaged");
    if (!rule) Note("what stopped its run is not known: rates saved from it have anytime-valid intervals");
  }
  const size_t num_conditions = description_.conditions.size();
  frame_ = {ComputeChecksum({description_.identity}), num_conditions, description_.estimators.size()};
  IsUndamaged([&] { CheckSchema(file_.database); }, note);
  IsUndamaged([&] { totals_ = TrialTotals::Read(file_.database); }, note);
  if (totals_ && totals_->num_conditions() != num_conditions) {
    Note("table totals has other conditions than the study");
    totals_.reset();
  }
}

std::optional<RunDescription> Salvage::ReadStored() {
  std::optional<RunDescription> stored;
  const auto read = [&] {
    CheckTables(file_.database, DescriptionTables());
    stored = ReadDescription(file_.database);
  };
  IsUndamaged(read, [&](const char* what) { Note(what); });
  return stored;
}

RunDescription Salvage::DescribeStudy() {
  CheckTables(file_.database, {"run"});
  Study study = ReadStoredStudy(file_.database, file_.path);
  study.trials = 1;
  study.description.clear();
  study.ademp.reset();
  study.hypotheses.clear();
  return Describe(MakePlan(study, file_.path, PlanEstimators::kNotMade));
}

std::vector<SalvagedCondition> Salvage::ForEachSoundTrial(
    const std::function<void(const StoredTrial&)>& keep) {
  std::vector<SalvagedCondition> conditions;
  for (std::uint32_t c = 0; c < description_.conditions.size(); ++c)
    conditions.push_back(SalvageCondition(c, keep));
  return conditions;
}

SalvagedCondition Salvage::SalvageCondition(std::uint32_t condition,
                                            const std::function<void(const StoredTrial&)>& keep) {
  SalvagedCondition salvaged;
  if (totals_) salvaged.num_counted = totals_->Of(condition).num_trials;
  TrialTotal total;
  ForEachReachable(file_.database, condition, [&](std::int64_t number) {
    const auto trial = static_cast<std::uint32_t>(number);
    std::optional<StoredTrial> found;
    const auto read = [&] { found = ReadStoredTrial(file_.database, frame_, condition, trial); };
    const bool is_sound = IsUndamaged(read, [&](const char* what) { Note(what); });
    if (!is_sound || !found) return;
    total.Add(found->checksum);
    Append(trial, &salvaged.sound);
    keep(*found);
  });
  salvaged.num_sound = total.num_trials;
  if (totals_ && salvaged.num_counted == total.num_trials && !(totals_->Of(condition) == total))
    Note(fmt::format("condition {}: the trials are others than those that were counted", condition));
  return salvaged;
}

void Salvage::Note(const std::string& finding) {
  if (findings_.size() < kMaxFindings && std::ranges::count(findings_, finding) == 0)
    findings_.push_back(finding);
}

}  // namespace rcme
