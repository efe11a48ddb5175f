#include "experiments/statistics/run_counts.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/run/store/trial_writer.h"
#include "parameters/parameter.h"
#include "parameters/text_lines.h"

namespace rcme {
namespace {

// A bijection of 64 bits whose values look random (the finaliser of SplitMix64, Steele, Lea & Flood 2014).
std::uint64_t HashOfTrial(std::uint32_t condition, std::uint32_t trial) {
  std::uint64_t z = (std::uint64_t{condition} << 32 | trial) + 0x9e3779b97f4a7c15;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return z ^ (z >> 31);
}

// Keeps the trials with the least hashes.
void KeepByHash(std::uint64_t hash, const StoredTrial& trial, size_t num,
                std::map<std::uint64_t, StoredTrial>* kept) {
  if (kept->size() >= num && hash >= kept->rbegin()->first) return;
  kept->emplace(hash, trial);
  if (kept->size() > num) kept->erase(std::prev(kept->end()));
}

std::uint32_t PlaceIn(const std::string& text) {
  long long place = 0;
  if (!ParseInteger(text, &place) || place < 0 || place > 2'000'000'000)
    throw Damage(fmt::format("'{}' of table counted is not possible", text));
  return static_cast<std::uint32_t>(place);
}

StoredCounts MakeStoredCounts(const ConditionCounts& condition) {
  StoredCounts texts;
  for (const auto& [shard, places] : condition.places) texts.places.push_back({shard, places.Text()});
  texts.quantities = condition.cell.Texts();
  return texts;
}

}  // namespace

void Places::Add(std::uint32_t place) {
  if (place >= has_.size()) has_.resize(std::max<size_t>(place + size_t{1}, 2 * has_.size()));
  num_ += !has_[place];
  has_[place] = true;
}

Places Places::First(std::uint32_t num) {
  Places places;
  places.has_.assign(num, true);
  places.num_ = num;
  return places;
}

void Places::AddAll(const Places& other) {
  for (std::uint32_t place = 0; place < other.has_.size(); ++place) {
    if (other.has_[place]) Add(place);
  }
}

bool Places::Intersects(const Places& other) const {
  for (std::uint32_t place = 0; place < std::min(has_.size(), other.has_.size()); ++place) {
    if (has_[place] && other.has_[place]) return true;
  }
  return false;
}

std::vector<TrialRange> Places::Missing(std::uint32_t end) const {
  std::vector<TrialRange> missing;
  for (std::uint32_t place = 0; place < end; ++place) {
    if (Has(place)) continue;
    if (missing.empty() || missing.back().end != place) missing.push_back({place, place});
    missing.back().end = place + 1;
  }
  return missing;
}

std::string Places::Text() const {
  std::string text;
  for (size_t first = 0; first < has_.size(); ++first) {
    if (!has_[first]) continue;
    size_t last = first;
    while (last + 1 < has_.size() && has_[last + 1]) ++last;
    text += fmt::format("{}{}", text.empty() ? "" : ",", first);
    if (last > first) text += fmt::format("-{}", last);
    first = last;
  }
  return text;
}

Places Places::FromText(const std::string& text) {
  Places places;
  for (const std::string& range : SplitText(text, ',')) {
    const size_t dash = range.find('-');
    const std::uint32_t first = PlaceIn(range.substr(0, dash));
    const std::uint32_t last = dash == std::string::npos ? first : PlaceIn(range.substr(dash + 1));
    if (last < first || first < places.has_.size())
      throw Damage(fmt::format("'{}' of table counted is not possible", range));
    places.has_.resize(first);
    places.has_.resize(last + size_t{1}, true);
    places.num_ += last - first + 1;
  }
  return places;
}

void KeptTrials::Add(const StoredTrial& trial, const FailureBounds& bounds) {
  const std::uint64_t hash = HashOfTrial(trial.problem.condition, trial.problem.trial);
  KeepByHash(hash, trial, kNumSampled, &sampled_);
  if (std::ranges::any_of(trial.records, [&](const TrialRecord& r) { return HasFailed(r, bounds); }))
    KeepByHash(hash, trial, kNumFailed, &failed_);
}

std::map<std::uint32_t, StoredTrial> KeptTrials::All() const {
  std::map<std::uint32_t, StoredTrial> all;
  for (const auto* kept : {&sampled_, &failed_}) {
    for (const auto& [hash, trial] : *kept) all.emplace(trial.problem.trial, trial);
  }
  return all;
}

const Places& ConditionCounts::FindPlaces(const std::string& shard) const {
  static const Places none;
  const auto found = places.find(shard);
  return found == places.end() ? none : found->second;
}

RunCounts::RunCounts(const RunDescription& description)
    : run(description), conditions(run.conditions.size(), ConditionCounts(run.estimators.size())) {}

std::int64_t RunCounts::NumTrials() const {
  std::int64_t sum = 0;
  for (const ConditionCounts& condition : conditions) sum += condition.cell.num_trials();
  return sum;
}

RunCounts ReadCounts(const ResultFile& file) {
  if (!file.description.keeps_counts)
    throw InputError(fmt::format("{}: holds trials, not counts", file.path));
  RunCounts counts(file.description);
  const std::vector<StoredCounts> stored = ReadStoredCounts(file);
  for (size_t c = 0; c < stored.size(); ++c) {
    ConditionCounts& condition = counts.conditions[c];
    std::int64_t num_trials = 0;
    for (const CountedPlaces& row : stored[c].places)
      num_trials += (condition.places[row.shard] = Places::FromText(row.places)).num();
    condition.cell = SummaryCell::FromTexts(stored[c].quantities, counts.run.estimators.size(), num_trials);
  }
  file.ForEachTrial(std::nullopt, [&](const StoredTrial& trial) {
    counts.conditions.at(trial.problem.condition).kept.Add(trial, counts.run.failure);
  });
  return counts;
}

void WriteCounts(const RunCounts& counts, const std::set<std::uint32_t>& conditions, ResultFile* file) {
  SQLite::Transaction change(file->database);
  TrialWriter writer(file);
  for (const std::uint32_t c : conditions) {
    const ConditionCounts& condition = counts.conditions[c];
    for (const char* table : {"problems", "trials"})
      file->database.exec(fmt::format("DELETE FROM {} WHERE condition = {}", table, c));
    file->totals.Clear(c);
    for (const auto& [number, trial] : condition.kept.All()) writer.AddTrial(trial.problem, trial.records);
    WriteStoredCounts(file, c, MakeStoredCounts(condition));
  }
  file->totals.WriteChanged(file->database);
  change.commit();
}

}  // namespace rcme
