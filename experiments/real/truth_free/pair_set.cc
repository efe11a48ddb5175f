#include "experiments/real/truth_free/pair_set.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <string>

#include "experiments/data/make_data.h"
#include "experiments/data/match_file.h"
#include "experiments/data/match_folder.h"
#include "experiments/data/simulated_sequence.h"

namespace rcme {
namespace {

std::string NameSet(const StudyPlan& plan, const Condition& condition) {
  return condition.levels.empty() ? plan.study.name : fmt::format("{}", fmt::join(condition.levels, ", "));
}

}  // namespace

std::vector<PairSet> PairSetsOfFolder(const std::string& folder, std::optional<double> sigma_px) {
  std::map<std::string, PairSet> sets;
  InputWarnings warnings;
  StatedSigmas sigmas;
  for (const std::filesystem::path& path : MatchFilesIn(folder)) {
    MatchFile file = ReadMatchFile(path.string());
    warnings.Add(file.doubts);
    if (!sigma_px) sigmas.Add(file);
    PairSet& set = sets[file.scene];
    set.name = file.scene;
    NamedPair pair{path.filename().string(), file.image1, file.image2, {}, file.seconds_between};
    pair.problem = MakeMotionProblem(std::move(file), sigma_px);
    pair.problem.prior.reset();  // answers that share one are not independent
    set.pairs.push_back(std::move(pair));
  }
  warnings.Print();
  std::vector<PairSet> all;
  for (auto& [scene, set] : sets) all.push_back(std::move(set));
  return all;
}

std::vector<PairSet> PairSetsOfStudy(const StudyPlan& plan) {
  std::vector<PairSet> all;
  for (const Condition& condition : plan.conditions) {
    PairSet set{NameSet(plan, condition), {}};
    // Simulated motions are even in time and take the same time in each pair; for real pairs it is not known.
    const double seconds_between =
        condition.source->SharedScene() ? std::numeric_limits<double>::quiet_NaN() : 1.0;
    for (int trial = 0; trial < condition.num_trials; ++trial) {
      const auto number = static_cast<std::uint32_t>(trial);
      set.pairs.push_back({fmt::format("{} trial {}", set.name, trial), "", "",
                           condition.source->Make(NameOfScene(plan, condition, number)).problem,
                           seconds_between});
    }
    all.push_back(std::move(set));
  }
  return all;
}

std::vector<PairSet> SequencesOfStudy(const StudyPlan& plan, int num_images) {
  std::vector<PairSet> all;
  for (const Condition& condition : plan.conditions) {
    if (!condition.source->FindScene(NameOfScene(plan, condition, 0)))
      throw InputError(fmt::format("study {}: a sequence of images needs simulated scenes, not real pairs",
                                   plan.study.name));
    const std::shared_ptr<const SimulatedData> data =
        MakeSimulatedData(CombineSettings(plan.study, condition.levels), BaselineTiming::kWithFirstScene);
    PairSet set{NameSet(plan, condition), {}};
    for (int trial = 0; trial < condition.num_trials; ++trial) {
      const StreamName name = NameOfScene(plan, condition, static_cast<std::uint32_t>(trial));
      const auto name_image = [&](int image) { return fmt::format("trial {:06} image {:02}", trial, image); };
      for (SequencePair& pair : SimulateSequence(*data, name, num_images))
        set.pairs.push_back(
            {fmt::format("{} trial {} images {} and {}", set.name, trial, pair.image1, pair.image2),
             name_image(pair.image1), name_image(pair.image2), std::move(pair.data.problem)});
    }
    all.push_back(std::move(set));
  }
  return all;
}

std::vector<ImageNumbers> NumberImages(const std::vector<PairAnswers>& answers) {
  std::map<std::string, std::int64_t> number_of;
  std::int64_t next = 0;
  const auto number = [&](const std::string& image) {
    const auto [at, is_new] = number_of.try_emplace(image, next);
    next += is_new;
    return at->second;
  };
  std::vector<ImageNumbers> numbers;
  for (const PairAnswers& each : answers) {
    const NamedPair& pair = each.whole.pair;
    if (pair.image1.empty() || pair.image2.empty()) {
      numbers.push_back({next, next});
      ++next;
    } else {
      const std::int64_t first = number(pair.image1);
      numbers.push_back({first, number(pair.image2)});
    }
  }
  return numbers;
}

}  // namespace rcme
