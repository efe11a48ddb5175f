#include "stats/level_crossing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "stats/constants.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

// Steepness of the logistic curves: change of the log-odds over all levels.
constexpr std::array kSteepness = {2.0, 5.0, 12.0, 30.0, 80.0};

// Sum over the levels first, ..., end - 1.
EventsAtLevel SumOver(std::span<const EventsAtLevel> events, size_t first, size_t end) {
  EventsAtLevel sum;
  for (const EventsAtLevel& one : events.subspan(first, end - first)) {
    sum.num_events += one.num_events;
    sum.num_trials += one.num_trials;
  }
  return sum;
}

// Whether the crossing between the levels c - 1 and c contradicts the numbers; each test at level `alpha`.
bool IsRejected(std::span<const EventsAtLevel> events, size_t c, double rate,
                const std::vector<size_t>& widths, double alpha) {
  return std::ranges::any_of(widths, [&](size_t width) {
    const EventsAtLevel below = SumOver(events, c - std::min(c, width), c);
    const EventsAtLevel above = SumOver(events, c, std::min(c + width, events.size()));
    return BinomialUpperTail(static_cast<int>(below.num_trials), static_cast<int>(below.num_events), rate) <=
               alpha ||
           BinomialCdf(above.num_events, above.num_trials, rate) <= alpha;
  });
}

// log(1 + exp(z)).
double LogOnePlusExp(double z) { return std::max(z, 0.0) + std::log1p(std::exp(-std::abs(z))); }

// The position of the maximum of a unimodal function: golden-section search.
double FindMaximum(const std::function<double(double)>& function, double low, double high) {
  constexpr double kGolden = 0.6180339887498949;
  double inner_low = high - kGolden * (high - low), inner_high = low + kGolden * (high - low);
  double value_low = function(inner_low), value_high = function(inner_high);
  for (int i = 0; i < 50; ++i) {
    if (value_low < value_high) {
      low = inner_low;
      inner_low = inner_high, value_low = value_high;
      value_high = function(inner_high = low + kGolden * (high - low));
    } else {
      high = inner_high;
      inner_high = inner_low, value_high = value_low;
      value_low = function(inner_low = high - kGolden * (high - low));
    }
  }
  return 0.5 * (low + high);
}

// The profile log-likelihood of a non-decreasing logistic curve through `rate` at `crossing`, maximised over
// the steepness, in which it is concave.
double ProfileLogLikelihood(std::span<const EventsAtLevel> events, double rate, double crossing) {
  constexpr double kMostSteepness = 1000.0;
  const double log_odds = std::log(rate / (1.0 - rate));
  const auto log_likelihood = [&](double steepness) {
    double sum = 0.0;
    for (const EventsAtLevel& one : events) {
      const double z = log_odds + steepness * (one.level - crossing);
      sum += static_cast<double>(one.num_events) * z - static_cast<double>(one.num_trials) * LogOnePlusExp(z);
    }
    return sum;
  };
  return log_likelihood(FindMaximum(log_likelihood, 0.0, kMostSteepness));
}

constexpr size_t kNumLevels = 1024;           // of the search, over [0, 1]
constexpr std::int64_t kNumSearchSteps = 40;  // of the search
constexpr std::int64_t kNumFreshLevels = 16;  // of the second part

// Part `i` of a total divided into `num_parts`, equal to within one.
std::int64_t EvenPart(std::int64_t total, std::int64_t i, std::int64_t num_parts) {
  return total * (i + 1) / num_parts - total * i / num_parts;
}

double PlaceOfLevel(size_t level) { return (static_cast<double>(level) + 0.5) / kNumLevels; }

// The levels of the second part, ascending: evenly spaced over the central 99 % of the posterior, widened on
// both sides by its width.
std::vector<size_t> ChooseFreshLevels(const CrossingSearch& search, double margin) {
  const double low = search.Quantile(0.005), high = search.Quantile(0.995);
  std::vector<size_t> levels;
  for (std::int64_t i = 0; i < kNumFreshLevels; ++i) {
    const double place =
        low - margin + (high - low + 2.0 * margin) * (static_cast<double>(i) + 0.5) / kNumFreshLevels;
    levels.push_back(static_cast<size_t>(std::clamp(std::floor(place), 0.0, kNumLevels - 1.0)));
  }
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  return levels;
}

// Levels that are run at the same place are one; there are at least four places, if the range has so many.
std::vector<size_t> ChooseFreshLevels(const CrossingSearch& search, const PlaceOfRun& place_of_run) {
  const double width = search.Quantile(0.995) - search.Quantile(0.005) + 1.0;
  if (!place_of_run) return ChooseFreshLevels(search, width);
  for (double margin = width;; margin *= 2.0) {
    std::vector<size_t> levels = ChooseFreshLevels(search, margin);
    const auto place = [&](size_t level) { return place_of_run(PlaceOfLevel(level)); };
    levels.erase(
        std::unique(levels.begin(), levels.end(), [&](size_t a, size_t b) { return place(a) == place(b); }),
        levels.end());
    if (levels.size() >= 4 || margin > kNumLevels) return levels;
  }
}

}  // namespace

CrossingSearch::CrossingSearch(size_t num_levels, double rate)
    : num_levels_(num_levels), log_weights_(kSteepness.size() * (num_levels + 1)) {
  const double log_odds = std::log(rate / (1.0 - rate)), size = static_cast<double>(num_levels);
  for (const double steepness : kSteepness) {
    for (size_t d = 0; d < 2 * num_levels;
         ++d) {  // level - crossing = d - num_levels, counted from its centre
      const double z = log_odds + steepness * (static_cast<double>(d) - size + 0.5) / size;
      log_rates_.push_back(-std::log1p(std::exp(-z)));
      log_rests_.push_back(-std::log1p(std::exp(z)));
    }
  }
}

void CrossingSearch::Add(size_t level, std::int64_t num_events, std::int64_t num_trials) {
  const auto k = static_cast<double>(num_events), rest = static_cast<double>(num_trials - num_events);
  for (size_t s = 0; s < kSteepness.size(); ++s) {
    for (size_t c = 0; c <= num_levels_; ++c) {
      const size_t curve = s * 2 * num_levels_ + level + num_levels_ - c;
      log_weights_[s * (num_levels_ + 1) + c] += k * log_rates_[curve] + rest * log_rests_[curve];
    }
  }
}

double CrossingSearch::Quantile(double probability) const {
  const double greatest = std::ranges::max(log_weights_);
  std::vector<double> weights(num_levels_ + 1);
  double sum = 0.0;
  for (size_t i = 0; i < log_weights_.size(); ++i) {
    const double weight = std::exp(log_weights_[i] - greatest);
    weights[i % weights.size()] += weight;
    sum += weight;
  }
  double below = 0.0;
  for (size_t c = 0; c < num_levels_; ++c) {
    below += weights[c];
    if (below >= probability * sum) return static_cast<double>(c);
  }
  return static_cast<double>(num_levels_);
}

size_t CrossingSearch::NextLevel(size_t step) const {
  constexpr std::array kQuantiles = {0.5, 0.15, 0.85, 0.3, 0.7};
  const auto crossing = static_cast<size_t>(Quantile(kQuantiles[step % kQuantiles.size()]));
  // Alternates between the levels above and below the crossing.
  const size_t level = step % 2 == 0 ? crossing : crossing - std::min<size_t>(crossing, 1);
  return std::min(level, num_levels_ - 1);
}

Interval FindCrossingInterval(std::span<const EventsAtLevel> events, double rate, double confidence) {
  std::vector<size_t> widths;
  for (size_t width = 1; width < events.size(); width *= 2) widths.push_back(width);
  widths.push_back(events.size());
  const double alpha = (1.0 - confidence) / (2.0 * static_cast<double>(widths.size()));
  Interval interval{kInfinity, -kInfinity};
  for (size_t c = 0; c <= events.size(); ++c) {
    if (IsRejected(events, c, rate, widths, alpha)) continue;
    interval.lower = std::min(interval.lower, c == 0 ? -kInfinity : events[c - 1].level);
    interval.upper = std::max(interval.upper, c == events.size() ? kInfinity : events[c].level);
  }
  return interval.lower < interval.upper ? interval : Interval{-kInfinity, kInfinity};
}

// For a convex set {a + b x} of lines, the places where they cross a value form an interval. The profile
// likelihood therefore rises to its maximum and then falls.
Interval FindLogisticInterval(std::span<const EventsAtLevel> events, double rate, double confidence) {
  const auto profile = [&](double crossing) { return ProfileLogLikelihood(events, rate, crossing); };
  const double best = FindMaximum(profile, 0.0, 1.0);
  const double greatest = std::max({profile(best), profile(0.0), profile(1.0)});
  const double least = greatest - 0.5 * ChiSquareQuantile(1, confidence);
  // The last accepted place between the best and the end.
  const auto find_end = [&](double end, double beyond) {
    if (profile(end) >= least) return beyond;
    double accepted = best, rejected = end;
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (accepted + rejected);
      (profile(middle) >= least ? accepted : rejected) = middle;
    }
    return accepted;
  };
  return {find_end(0.0, -kInfinity), find_end(1.0, kInfinity)};
}

Crossing FindCrossing(const AskLevel& ask, double rate, std::int64_t num_trials, double confidence,
                      const PlaceOfRun& place_of_run) {
  CrossingSearch search(kNumLevels, rate);
  Crossing crossing;
  const auto ask_at = [&](size_t level, std::int64_t number, std::vector<EventsAtLevel>* asked) {
    const double place = PlaceOfLevel(level);
    asked->push_back(ask(place_of_run ? place_of_run(place) : place, number));
    search.Add(level, asked->back().num_events, asked->back().num_trials);
  };
  const std::int64_t num_searched = num_trials / 3, num_steps = std::min(kNumSearchSteps, num_searched);
  for (std::int64_t step = 0; step < num_steps; ++step) {
    const size_t level = search.NextLevel(static_cast<size_t>(step));
    ask_at(level, EvenPart(num_searched, step, num_steps), &crossing.searched);
  }
  const std::vector<size_t> levels = ChooseFreshLevels(search, place_of_run);
  for (std::int64_t i = 0; i < std::ssize(levels); ++i) {
    const std::int64_t number = EvenPart(num_trials - num_searched, i, std::ssize(levels));
    ask_at(levels[static_cast<size_t>(i)], number, &crossing.fresh);
  }
  const bool is_known = SumOver(crossing.searched, 0, crossing.searched.size()).num_trials > 0 ||
                        SumOver(crossing.fresh, 0, crossing.fresh.size()).num_trials > 0;
  crossing.estimate = is_known ? search.Quantile(0.5) / kNumLevels : kNaN;
  crossing.interval = FindCrossingInterval(crossing.fresh, rate, confidence);
  crossing.logistic_interval = FindLogisticInterval(crossing.fresh, rate, confidence);
  crossing.estimate = std::clamp(crossing.estimate, crossing.interval.lower, crossing.interval.upper);
  return crossing;
}

}  // namespace rcme
