#include "experiments/study/population.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "experiments/data/make_data.h"
#include "experiments/study/study.h"
#include "parameters/input_error.h"
#include "parameters/parameter.h"
#include "parameters/settings.h"
#include "parameters/text_lines.h"
#include "stats/fnv1a.h"

namespace rcme {
namespace {

constexpr const char *kDrawsLine = "# draws: ", *kChosenLine = "# chosen draws: ", *kDrawLine = "# draw ",
                     *kOutsideWord = ": outside of given: ";

bool IsWith(const DrawnKey& drawn, const Settings& settings) {
  return std::ranges::all_of(
      drawn.with, [&](const auto& choice) { return FindSetting(settings, choice.first) == choice.second; });
}

// The value at u in [0, 1), formatted with six digits.
std::string ValueAt(const DrawnRange& range, bool is_whole, double u) {
  if (range.kind == DrawnRange::Kind::kAnyOf)
    return range.words[static_cast<size_t>(u * static_cast<double>(range.words.size()))];
  const double to = range.to + (is_whole ? 1.0 : 0.0);
  const double value = range.kind == DrawnRange::Kind::kUniform
                           ? range.from + u * (to - range.from)
                           : range.from * std::exp(u * std::log(to / range.from));
  // Rounding may move the greatest u to `to`.
  if (is_whole) return fmt::format("{:.0f}", std::min(std::floor(value), range.to));
  return fmt::format("{:.6g}", value);
}

// Reads a side of a restriction as a number; returns false if the draw does not have it.
bool ReadSide(const Settings& resolved, const std::string& side, double* number) {
  if (ParseReal(side, number)) return true;
  return ParseReal(FindSetting(resolved, side).value_or(""), number);
}

bool Meets(const Settings& resolved, const Restriction& restriction) {
  double left = 0.0, right = 0.0;
  if (!ReadSide(resolved, restriction.left, &left) || !ReadSide(resolved, restriction.right, &right))
    return true;
  if (restriction.comparison == "<") return left < right;
  if (restriction.comparison == "<=") return left <= right;
  if (restriction.comparison == ">") return left > right;
  return left >= right;
}

class Drawer {
 public:
  explicit Drawer(const Study& study)
      : study_(study), population_(*study.population), keys_(ListDrawnKeys(population_)) {
    std::vector<std::uint64_t> hashes;
    for (const std::string& key : keys_) hashes.push_back(HashToStreamKey(key));
    points_ = DrawPoints(population_.design, NumPoints(), hashes, study.seed,
                         static_cast<std::uint32_t>(StreamPurpose::kPopulation));
  }

  PopulationDraw Draw(int number) {
    const std::vector<double>& point = points_[static_cast<size_t>(number)];
    Settings settings = study_.data;
    for (const DrawnKey& drawn : population_.keys) {
      if (!IsChoice(drawn.key) || !IsWith(drawn, settings)) continue;
      settings.emplace_back(drawn.key, ValueAt(drawn.range, false, point[FindAxis(drawn.key)]));
    }
    const std::map<std::string, bool>& is_whole = KeysWith(settings);
    const Settings resolved_choices = ResolveSettings(settings);
    for (const auto& [key, drawn] : ListDrawnNumbers(resolved_choices, is_whole))
      settings.emplace_back(key, ValueAt(drawn->range, is_whole.at(key), point[FindAxis(key)]));
    const Settings resolved = ResolveSettings(settings);
    PopulationDraw draw{number, {}, {}};
    for (const std::string& key : keys_) {
      const bool is_drawn = std::any_of(settings.begin() + std::ssize(study_.data), settings.end(),
                                        [&](const auto& setting) { return setting.first == key; });
      draw.levels.push_back(is_drawn ? FindSetting(resolved, key).value() : kNotDrawn);
    }
    for (const Restriction& restriction : population_.given) {
      if (draw.outside_of.empty() && !Meets(resolved, restriction)) draw.outside_of = restriction.Text();
    }
    return draw;
  }

 private:
  size_t NumPoints() const {
    const int last = population_.draws.empty() ? 0 : population_.draws.back();
    if (last < population_.number) return static_cast<size_t>(population_.number);
    if (population_.design == PointSet::kLatinHypercube)
      throw InputError(fmt::format(
          "conditions: draws: {} is not below number ({}), which all draws of latin_hypercube depend on",
          last, population_.number));
    return static_cast<size_t>(last) + 1;
  }

  size_t FindAxis(const std::string& key) const {
    return static_cast<size_t>(std::ranges::find(keys_, key) - keys_.begin());
  }

  // Returns the keys that settings with these choices have, and whether they are whole numbers.
  const std::map<std::string, bool>& KeysWith(const Settings& settings) {
    std::string choices;
    for (const auto& [key, value] : settings) choices += IsChoice(key) ? key + "=" + value + "\n" : "";
    const auto [found, is_new] = keys_with_.try_emplace(choices);
    if (is_new) {
      for (const SettingHelp& help : DescribeSettings(settings))
        found->second[help.name] = help.IsWholeNumber();
    }
    return found->second;
  }

  // Returns the range of each key that is not a choice and that the draw has. The range nested deepest wins.
  std::map<std::string, const DrawnKey*> ListDrawnNumbers(const Settings& resolved,
                                                          const std::map<std::string, bool>& known) const {
    std::map<std::string, const DrawnKey*> numbers;
    for (const DrawnKey& drawn : population_.keys) {
      if (IsChoice(drawn.key) || !known.contains(drawn.key) || !IsWith(drawn, resolved)) continue;
      const DrawnKey*& best = numbers[drawn.key];
      if (best == nullptr || drawn.with.size() >= best->with.size()) best = &drawn;
    }
    return numbers;
  }

  const Study& study_;
  const Population& population_;
  const std::vector<std::string> keys_;
  std::vector<std::vector<double>> points_;
  std::map<std::string, std::map<std::string, bool>> keys_with_;
};

int CountDraws(const Population& population) {
  return population.draws.empty() ? population.number : static_cast<int>(population.draws.size());
}

}  // namespace

std::vector<std::string> ListDrawnKeys(const Population& population) {
  std::vector<std::string> keys;
  for (const DrawnKey& drawn : population.keys) {
    if (std::ranges::count(keys, drawn.key) == 0) keys.push_back(drawn.key);
  }
  return keys;
}

std::vector<PopulationDraw> DrawPopulation(const Study& study) {
  Drawer drawer(study);
  std::vector<PopulationDraw> draws;
  for (const int number : study.population->draws) draws.push_back(drawer.Draw(number));
  if (!draws.empty()) return draws;
  for (int i = 0; i < study.population->number; ++i) draws.push_back(drawer.Draw(i));
  return draws;
}

std::optional<int> FindDraw(const std::vector<std::string>& factors, const std::vector<std::string>& levels) {
  for (size_t f = 0; f < factors.size(); ++f)
    if (factors[f] == kDrawFactor) return std::stoi(levels[f]);
  return std::nullopt;
}

std::string DescribePopulationIdentity(const Population& population,
                                       const std::vector<RefusedDraw>& refused) {
  std::string text =
      fmt::format("{}{}\n", population.draws.empty() ? kDrawsLine : kChosenLine, CountDraws(population));
  for (const RefusedDraw& draw : refused)
    text += fmt::format("{}{}{}{}\n", kDrawLine, draw.number, kOutsideWord, draw.outside_of);
  return text;
}

bool IsSampleOfPopulation(const std::string& identity) {
  return identity.find(std::string("\n") + kDrawsLine) != std::string::npos;
}

bool HasChosenDraws(const std::string& identity) {
  return identity.find(std::string("\n") + kChosenLine) != std::string::npos;
}

std::string DescribePopulation(const std::string& identity) {
  int num_draws = 0, num_refused = 0;
  const char* what = "Population";
  std::map<std::string, int> num_outside;  // by restriction
  for (const std::string& line : SplitText(identity, '\n')) {
    for (const char* beginning : {kDrawsLine, kChosenLine}) {
      if (!line.starts_with(beginning)) continue;
      num_draws = std::atoi(line.c_str() + std::string_view(beginning).size());
      if (beginning == kChosenLine) what = "Chosen draws, no sample of the population";
    }
    const size_t outside = line.find(kOutsideWord);
    if (!line.starts_with(kDrawLine) || outside == std::string::npos) continue;
    ++num_refused;
    ++num_outside[line.substr(outside + std::string_view(": ").size())];
  }
  if (num_draws == 0) return {};
  std::string text =
      fmt::format("{}: {} of {} draws are conditions", what, num_draws - num_refused, num_draws);
  for (const auto& [restriction, count] : num_outside) text += fmt::format("\n  {} {}", count, restriction);
  return text;
}

}  // namespace rcme
