#include "experiments/audit/claims/outcomes_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "experiments/core/work/part_file.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

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

}  // namespace

std::vector<size_t> StatisticsOf(const Check& check) {
  std::vector<size_t> statistics;
  for (const Target& target : check.targets) statistics.push_back(target.statistic);
  if (check.difficulty_statistic) statistics.push_back(*check.difficulty_statistic);
  std::ranges::sort(statistics);
  statistics.erase(std::unique(statistics.begin(), statistics.end()), statistics.end());
  return statistics;
}

std::string OutcomesAsJson(const Check& check, const std::vector<Outcome>& outcomes) {
  Json columns = Json::array();
  for (const size_t statistic : StatisticsOf(check)) columns.push_back(ColumnAsJson(outcomes, statistic));
  return columns.dump();
}

std::vector<Outcome> OutcomesFrom(const Check& check, const std::string& text, size_t num_trials) {
  const Json json = ParsePiece(text);
  const std::vector<size_t> statistics = StatisticsOf(check);
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

}  // namespace rcme
