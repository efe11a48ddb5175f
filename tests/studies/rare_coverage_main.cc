// Do the intervals of multilevel splitting hold a rate that is known? Repeats `rcme rare` with fresh seeds
// and as little effort as can be (`scripts/results rare_noise` makes those of results/rare):
//   rcme_rare_coverage STUDY KEY=VALUE KNOWN_RATE FOLDER [REPEATS, default 200]
// of a study that KEY=VALUE leaves one condition of. Writes FOLDER/coverage.csv, a row for each repetition,
// and prints what they say together, FOLDER/coverage.txt.

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <exception>
#include <string>

#include "experiments/commands/study_source.h"
#include "experiments/core/files/file_output.h"
#include "experiments/rare/split_failures.h"
#include "stats/intervals.h"
#include "stats/moments.h"
#include "tests/test_support/in_memory.h"

namespace rcme {
namespace {

constexpr RareEffort kEffort{{.num_particles = 60, .num_moves = 2}, 6};

struct Coverage {
  std::int64_t num_holding = 0, n = 0;
  void Add(bool holds) { num_holding += holds, ++n; }
  std::string Describe() const {
    const Interval exact = ExactBinomialInterval(num_holding, n);
    return fmt::format("{} of {} [{:.3f}, {:.3f}]", num_holding, n, exact.lower, exact.upper);
  }
};

void Repeat(const StudyPlan& plan, double known_rate, const std::string& folder, int num_repeats) {
  std::string rows = "seed,value,lower,upper,trusted,calls\n";
  Coverage of_all, of_trusted;
  Moments estimates, calls;
  for (int repeat = 0; repeat < num_repeats; ++repeat) {
    const std::uint64_t seed = plan.study.seed + static_cast<std::uint64_t>(repeat);
    const SplittingRate rate = SplitInMemory(plan, seed, kEffort, 1).at(0).rate;
    const bool holds = rate.interval.Contains(known_rate);
    of_all.Add(holds);
    if (rate.IsTrusted()) of_trusted.Add(holds);
    if (!std::isnan(rate.estimate)) estimates.Add(rate.estimate);
    calls.Add(static_cast<double>(rate.num_values));
    rows += fmt::format("{},{},{},{},{},{}\n", seed, rate.estimate, rate.interval.lower, rate.interval.upper,
                        rate.IsTrusted() ? 1 : 0, rate.num_values);
  }
  const double relative_sd = std::sqrt(estimates.variance()) / estimates.mean();
  // Relative variance times cost, of that of plain trials: (1 - p) / (p n) after n of them.
  const double share = calls.mean() * relative_sd * relative_sd * known_rate / (1.0 - known_rate);
  const std::string words = fmt::format(
      "{}: {} repetitions of {} replicates of {} particles, {} moves; known rate {:g}\n"
      "mean of the estimates        {:.3e} +- {:.1e}\n"
      "relative standard deviation  {:.2f}, of {:.0f} calls on average\n"
      "cost of plain trials         {:.2g} % for the same variance\n"
      "intervals that hold the rate {}\n"
      "of those that are trusted    {}\n",
      plan.study.name, num_repeats, kEffort.num_replicates, kEffort.splitting.num_particles,
      kEffort.splitting.num_moves, known_rate, estimates.mean(), estimates.standard_error(), relative_sd,
      calls.mean(), 100.0 * share, of_all.Describe(), of_trusted.Describe());
  WriteFileWhole(folder + "/coverage.csv", rows);
  WriteFileWhole(folder + "/coverage.txt", words);
  fmt::print("{}", words);
}

template <typename Number>
Number ParseNumber(const std::string& text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size())
    throw std::invalid_argument("'" + text + "' is no number");
  return number;
}

}  // namespace
}  // namespace rcme

int main(int argc, char** argv) {
  using namespace rcme;
  if (argc != 5 && argc != 6) {
    fmt::print(stderr, "usage: rcme_rare_coverage STUDY KEY=VALUE KNOWN_RATE FOLDER [REPEATS]\n");
    return 2;
  }
  try {
    const StudyPlan plan = MakePlan(LoadChangedStudy(argv[1], {{argv[2]}, {}, -1}), argv[1]);
    Repeat(plan, ParseNumber<double>(argv[3]), argv[4], argc == 6 ? ParseNumber<int>(argv[5]) : 200);
  } catch (const std::exception& error) {
    fmt::print(stderr, "rcme_rare_coverage: {}\n", error.what());
    return 2;
  }
}
