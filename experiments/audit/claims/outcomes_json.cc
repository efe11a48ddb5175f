#include "experiments/audit/claims/outcomes_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "experiments/core/work/part_file.h"
#include "stats/constants.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

// 0 is not -0.
std::optional<char> AsCharacter(double x) {
  if (std::isnan(x)) return 'n';
  if (x == 1.0) return '1';
  if (x == 0.0 && !std::signbit(x)) return '0';
  return std::nullopt;
}

double FromCharacter(char character) {
  if (character == 'n') return kNaN;
  if (character != '0' && character != '1') throw std::invalid_argument("an outcome that is none");
  return character == '1' ? 1.0 : 0.0;
}

Json ColumnAsJson(const std::vector<Outcome>& outcomes, size_t statistic) {
  std::string characters;
  for (const Outcome& outcome : outcomes) {
    const std::optional<char> character = AsCharacter(outcome.at(statistic));
    if (!character) break;
    characters += *character;
  }
  if (characters.size() == outcomes.size()) return characters;
  Json numbers = Json::array();
  for (const Outcome& outcome : outcomes) numbers.push_back(NumberAsJson(outcome[statistic]));
  return numbers;
}

std::vector<double> ColumnFrom(const Json& json) {
  std::vector<double> column;
  if (json.is_string()) {
    for (const char character : json.get<std::string>()) column.push_back(FromCharacter(character));
  } else if (!json.is_array()) {
    throw std::invalid_argument("outcomes that are no list");
  } else {
    for (const Json& number : json) column.push_back(NumberFrom(number));
  }
  return column;
}

void RequireInRange(const Target& target, const std::vector<Outcome>& outcomes) {
  if (target.kind != Target::Kind::kBoundedMean) return;
  for (const Outcome& outcome : outcomes) {
    const double value = outcome[target.statistic];
    if (value < target.range.lower || value > target.range.upper)
      throw std::invalid_argument(
          fmt::format("an outcome of {}, not of {} to {}", value, target.range.lower, target.range.upper));
  }
}

Json VerdictAsJson(const std::optional<Verdict>& verdict) {
  return verdict ? Json(static_cast<int>(*verdict)) : Json();
}

std::optional<Verdict> VerdictFrom(const Json& json) {
  if (json.is_null()) return std::nullopt;
  return static_cast<Verdict>(CountFrom(json, static_cast<std::int64_t>(Verdict::kUndecided)));
}

// The statistics that are stored.
std::vector<size_t> ListStatistics(const Check& check) {
  std::vector<size_t> statistics;
  for (const Target& target : check.targets) statistics.push_back(target.statistic);
  if (check.difficulty_statistic) statistics.push_back(*check.difficulty_statistic);
  std::ranges::sort(statistics);
  statistics.erase(std::unique(statistics.begin(), statistics.end()), statistics.end());
  return statistics;
}

}  // namespace

std::string OutcomesAsJson(const Check& check, const std::vector<Outcome>& outcomes) {
  Json columns = Json::array();
  for (const size_t statistic : ListStatistics(check)) columns.push_back(ColumnAsJson(outcomes, statistic));
  return columns.dump();
}

std::vector<Outcome> OutcomesFrom(const Check& check, const std::string& text, size_t num_trials) {
  const Json json = ParsePiece(text);
  const std::vector<size_t> statistics = ListStatistics(check);
  if (!json.is_array() || json.size() != statistics.size())
    throw std::invalid_argument(fmt::format("it has {} statistics, not {}", json.size(), statistics.size()));
  std::vector<Outcome> outcomes(num_trials, Outcome(statistics.empty() ? 0 : statistics.back() + 1, kNaN));
  for (size_t s = 0; s < statistics.size(); ++s) {
    const std::vector<double> column = ColumnFrom(json[s]);
    if (column.size() != num_trials)
      throw std::invalid_argument(fmt::format("it has {} trials, not {}", column.size(), num_trials));
    for (size_t i = 0; i < num_trials; ++i) outcomes[i][statistics[s]] = column[i];
  }
  for (const Target& target : check.targets) RequireInRange(target, outcomes);
  return outcomes;
}

std::string CheckResultAsJson(const CheckResult& result) {
  Json targets = Json::array(), fifths = Json::array();
  for (const TargetResult& target : result.targets) {
    targets.push_back({NumberAsJson(target.measured), NumberAsJson(target.interval.lower),
                       NumberAsJson(target.interval.upper), target.n, VerdictAsJson(target.verdict),
                       NumberAsJson(target.trials_to_decide)});
  }
  for (const DifficultyFifth& fifth : result.fifths) {
    fifths.push_back({NumberAsJson(fifth.easiest), NumberAsJson(fifth.hardest), NumberAsJson(fifth.measured),
                      NumberAsJson(fifth.interval.lower), NumberAsJson(fifth.interval.upper), fifth.n});
  }
  Json json =
      Json::array({result.num_trials, targets, VerdictAsJson(result.verdict), fifths, result.not_possible});
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

CheckResult CheckResultFrom(const Check& check, const std::string& text) {
  const Json json = ParsePiece(text);
  RequireSize(json, 5);
  const std::int64_t num_trials = CountFrom(json[0], check.limits.Max(Budget::kFull));
  CheckResult result{num_trials, {}, VerdictFrom(json[2]), {}, json[4].get<std::string>()};
  if (!json[1].empty()) RequireSize(json[1], check.targets.size());
  for (const Json& target : json[1]) {
    RequireSize(target, 6);
    result.targets.push_back({NumberFrom(target[0]),
                              {NumberFrom(target[1]), NumberFrom(target[2])},
                              CountFrom(target[3], num_trials),
                              VerdictFrom(target[4]),
                              NumberFrom(target[5])});
  }
  for (const Json& fifth : json[3]) {
    RequireSize(fifth, 6);
    result.fifths.push_back({NumberFrom(fifth[0]),
                             NumberFrom(fifth[1]),
                             NumberFrom(fifth[2]),
                             {NumberFrom(fifth[3]), NumberFrom(fifth[4])},
                             CountFrom(fifth[5], num_trials)});
  }
  return result;
}

}  // namespace rcme
