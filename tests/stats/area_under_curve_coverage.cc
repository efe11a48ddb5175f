// How often the 95 % interval of the area under the curve contains the truth (results/statistics;
// made by `scripts/results area_under_curve`):
//   area_under_curve_coverage [REPETITIONS, default 4000]
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string_view>

#include "stats/area_under_curve.h"
#include "stats/distributions.h"
#include "stats/random.h"

namespace rcme {
namespace {

constexpr double kAreas[] = {0.5, 0.6, 0.7, 0.8, 0.9, 0.95};

// Scores whose area is known: negatives are standard normal or exponential.
struct Law {
  const char* name;
  double (*positive)(double area, double standard_normal);  // a positive from a standard normal
  double (*negative)(double standard_normal);
};

double Same(double z) { return z; }
double Shifted(double area, double z) { return std::sqrt(2.0) * NormalQuantile(area) + z; }
double ShiftedWide(double area, double z) { return std::sqrt(10.0) * NormalQuantile(area) + 3.0 * z; }
double Exponential(double z) { return -std::log(NormalCdf(-z)); }
// Exponentials of means k and 1: P(positive > negative) = k / (1 + k).
double LongerExponential(double area, double z) { return area / (1.0 - area) * Exponential(z); }

const Law kLaws[] = {{"normal", Shifted, Same},
                     {"positives 3 times as wide", ShiftedWide, Same},
                     {"exponential", LongerExponential, Exponential}};

// `num_clusters` clusters with the given number of scores of each kind; half of the variance of the normal
// behind each score is common: to the scores of a kind in a cluster, or to both kinds.
struct Design {
  int num_clusters, positives_each, negatives_each;
  bool are_kinds_alike;
};

std::vector<ScoreCluster> Draw(const Law& law, const Design& design, double area, RandomStream& rng) {
  const bool is_shared = design.positives_each + design.negatives_each > 1;
  const auto mix = [&](double common) {
    return is_shared ? std::sqrt(0.5) * (common + rng.Normal()) : rng.Normal();
  };
  std::vector<ScoreCluster> clusters(static_cast<size_t>(design.num_clusters));
  for (ScoreCluster& cluster : clusters) {
    const double common = rng.Normal(), other = rng.Normal();
    for (int i = 0; i < design.positives_each; ++i)
      cluster.positives.push_back(law.positive(area, mix(common)));
    for (int i = 0; i < design.negatives_each; ++i)
      cluster.negatives.push_back(law.negative(mix(design.are_kinds_alike ? common : other)));
  }
  return clusters;
}

struct Counts {
  int covered = 0, plain = 0;  // by the interval, and by value +- 1.96 standard errors
  double width = 0.0;
};

Counts Measure(const Law& law, const std::vector<Design>& parts, double area, int repetitions,
               RandomStream& rng) {
  Counts counts;
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    std::vector<ScoreCluster> clusters;
    for (const Design& part : parts) {
      const std::vector<ScoreCluster> more = Draw(law, part, area, rng);
      clusters.insert(clusters.end(), more.begin(), more.end());
    }
    const AreaUnderCurve measured = MeasureClusteredAreaUnderCurve(clusters);
    counts.covered += measured.interval.Contains(area);
    counts.plain += std::abs(measured.value - area) <= 1.96 * measured.standard_error;
    counts.width += (measured.interval.upper - measured.interval.lower) / repetitions;
  }
  return counts;
}

void PrintRow(const std::string& name, const Law& law, const std::vector<Design>& parts, std::uint32_t row,
              int repetitions) {
  fmt::print("{:<46}", name);
  for (std::uint32_t a = 0; a < std::size(kAreas); ++a) {
    RandomStream rng({.seed = 1, .condition = row, .trial = a, .purpose = 150});
    const Counts counts = Measure(law, parts, kAreas[a], repetitions, rng);
    fmt::print("  {:.3f} ({:.3f}) {:.2f}", 1.0 * counts.covered / repetitions,
               1.0 * counts.plain / repetitions, counts.width);
  }
  fmt::print("\n");
  std::fflush(stdout);
}

void PrintTable(int repetitions) {
  fmt::print(
      "Coverage of the 95 % interval of the area under the curve (stats/area_under_curve.h), in brackets "
      "that of\n"
      "value +- 1.96 standard errors (DeLong, Obuchowski), then the mean width; {} repetitions, seed 1, so "
      "that a\n"
      "true 0.95 shows 0.943 to 0.957 in 95 of 100 cells.\n\n{:<46}",
      repetitions, "area");
  for (const double area : kAreas) fmt::print("  {:<18}", area);
  fmt::print("\n");
  std::uint32_t row = 0;
  for (const Law& law : kLaws) {
    for (const bool is_balanced : {true, false}) {
      for (const int n : {5, 10, 20, 50, 200}) {
        const int num_negatives = is_balanced ? n : 400;
        PrintRow(fmt::format("{}, {} and {}", law.name, n, num_negatives), law,
                 {{n, 1, 0, false}, {num_negatives, 0, 1, false}}, row++, repetitions);
      }
    }
  }
  fmt::print("\nScenes of 4 and 4, correlation 0.5 within a kind\n");
  for (const int n : {5, 10, 20, 50}) {
    PrintRow(fmt::format("normal, {} scenes", n), kLaws[0], {{n, 4, 4, false}}, row++, repetitions);
  }
  fmt::print("\nTrials with one of each, correlation 0.5 between them\n");
  for (const int n : {5, 10, 20, 50, 200}) {
    PrintRow(fmt::format("normal, {} trials", n), kLaws[0], {{n, 1, 1, true}}, row++, repetitions);
  }
}

}  // namespace
}  // namespace rcme

int main(int argc, char** argv) {
  int repetitions = 4000;
  if (argc > 1) {
    const std::string_view text = argv[1];
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), repetitions);
    if (argc > 2 || error != std::errc() || end != text.data() + text.size() || repetitions < 1) {
      fmt::print(stderr, "usage: area_under_curve_coverage [REPETITIONS] > TABLE.txt\n");
      return 2;
    }
  }
  rcme::PrintTable(repetitions);
  return 0;
}
