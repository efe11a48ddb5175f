#include "experiments/study/population.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "experiments/core/files/shared_files.h"
#include "experiments/core/work/for_each_index.h"
#include "experiments/data/make_data.h"
#include "experiments/study/population_file.h"
#include "experiments/study/study_file.h"
#include "experiments/study/study_plan.h"
#include "experiments/trial/trial.h"
#include "experiments/trial/trial_event.h"
#include "parameters/input_error.h"
#include "simulator/camera_registry.h"
#include "simulator/motion_registry.h"
#include "simulator/noise_registry.h"
#include "simulator/outlier_registry.h"
#include "simulator/scene_registry.h"
#include "tests/test_support/paths.h"

namespace rcme {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

Study DrawnStudy(const std::string& conditions, const std::string& more = "data: {num_matches: 60}\n") {
  return ParseStudy(more + "conditions:\n" + conditions + "estimators: [{name: standard}]\n", "study.yaml");
}

std::string CatchMessage(const std::string& conditions,
                         const std::string& more = "data: {num_matches: 60}\n") {
  try {
    DrawnStudy(conditions, more);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

// The level of a key in a draw.
std::string FindLevel(const Study& study, const PopulationDraw& draw, const std::string& key) {
  const std::vector<std::string> keys = ListDrawnKeys(*study.population);
  return draw.levels[static_cast<size_t>(std::ranges::find(keys, key) - keys.begin())];
}

const char kSmall[] =
    "  number: 64\n"
    "  ranges:\n"
    "    scene:\n"
    "      room: {num_boxes: [0, 10], cameras: [office, euroc]}\n"
    "      plane: {plane_depth_m: {log: [2, 20]}}\n"
    "    noise: any\n"
    "    sigma_px: log [0.1, 3]\n"
    "    outlier_ratio: [0, 0.8]\n"
    "    student_dof: [3, 10]\n"
    "    max_rotation_deg: {any: [1, 5, 20]}\n"
    "    outlier_count: bernoulli\n";

TEST(Population, DrawsEachKeyFromItsRange) {
  const Study study = DrawnStudy(kSmall);
  std::map<std::string, std::set<std::string>> seen;
  double sum_of_logs = 0.0;
  const std::vector<PopulationDraw> draws = DrawPopulation(study);
  ASSERT_EQ(draws.size(), 64U);
  for (const PopulationDraw& draw : draws) {
    for (const std::string& key : ListDrawnKeys(*study.population))
      seen[key].insert(FindLevel(study, draw, key));
    const double sigma_px = std::stod(FindLevel(study, draw, "sigma_px"));
    EXPECT_TRUE(sigma_px >= 0.1 && sigma_px <= 3.0);
    sum_of_logs += std::log(sigma_px);
  }
  // 64 points of Sobol's sequence have one in each 64th: their mean is that of the range but for a 64th of
  // it.
  EXPECT_NEAR(sum_of_logs / 64.0, 0.5 * std::log(0.3), std::log(30.0) / 64.0);
  EXPECT_EQ(seen["scene"], (std::set<std::string>{"room", "plane"}));
  EXPECT_EQ(seen["noise"].size(), NoiseRegistry().size());
  EXPECT_EQ(seen["outlier_count"], (std::set<std::string>{"bernoulli"}));
  EXPECT_EQ(seen["sigma_px"].size(), 64U);
}

TEST(Population, DrawsWhatBelongsToASceneOrALawWithItAlone) {
  const Study study = DrawnStudy(kSmall);
  for (const PopulationDraw& draw : DrawPopulation(study)) {
    const bool is_room = FindLevel(study, draw, "scene") == "room";
    EXPECT_EQ(FindLevel(study, draw, "num_boxes") != kNotDrawn, is_room);
    EXPECT_EQ(FindLevel(study, draw, "cameras") != kNotDrawn, is_room);
    EXPECT_EQ(FindLevel(study, draw, "plane_depth_m") != kNotDrawn, !is_room);
    // A flat key: wherever the noise law has it, and the motion of a room, hand_held, has no bound.
    EXPECT_EQ(FindLevel(study, draw, "student_dof") != kNotDrawn,
              FindLevel(study, draw, "noise") == "student_t");
    EXPECT_EQ(FindLevel(study, draw, "max_rotation_deg") != kNotDrawn, !is_room);
  }
}

TEST(Population, WholeNumbersIncludeBothEnds) {
  const Study study = DrawnStudy(
      "  number: 2000\n  design: random\n  ranges: {scene: room, num_boxes: [0, 3], num_matches: {log: [1, "
      "4]}}\n",
      "");
  std::map<std::string, int> boxes, matches;
  for (const PopulationDraw& draw : DrawPopulation(study)) {
    ++boxes[FindLevel(study, draw, "num_boxes")];
    ++matches[FindLevel(study, draw, "num_matches")];
  }
  ASSERT_EQ(boxes.size(), 4U);
  // Binomial counts: 500 +- 19 each; n in proportion to log((n + 1) / n), log 2 / log 5 of them 1: 861 +- 22.
  for (const auto& [level, count] : boxes) EXPECT_NEAR(count, 500, 80) << level;
  ASSERT_EQ(matches.size(), 4U);
  EXPECT_NEAR(matches["1"], 861, 90);
}

TEST(Population, MoreDrawsLeaveTheEarlierOnes) {
  for (const char* design : {"sobol", "random"}) {
    Study study = DrawnStudy(std::string("  design: ") + design + "\n" + kSmall);
    const std::vector<PopulationDraw> few = DrawPopulation(study);
    Override(&study, "conditions.number", "100");
    const std::vector<PopulationDraw> many = DrawPopulation(study);
    ASSERT_EQ(many.size(), 100U);
    for (size_t i = 0; i < few.size(); ++i) EXPECT_EQ(few[i].levels, many[i].levels);
  }
  Study study = DrawnStudy(kSmall);
  study.seed = 2;
  EXPECT_NE(DrawPopulation(study)[0].levels, DrawPopulation(DrawnStudy(kSmall))[0].levels);
}

TEST(Population, GivenKeepsThePlaces) {
  const Study all = DrawnStudy(kSmall);
  const Study some = DrawnStudy(std::string(kSmall) + "  given: [sigma_px < 1, 'student_dof >= 5']\n");
  const std::vector<PopulationDraw> draws = DrawPopulation(all), restricted = DrawPopulation(some);
  int num_outside = 0;
  for (size_t i = 0; i < draws.size(); ++i) {
    EXPECT_EQ(draws[i].levels, restricted[i].levels);
    const bool is_rough = std::stod(FindLevel(all, draws[i], "sigma_px")) >= 1.0;
    const std::string dof = FindLevel(all, draws[i], "student_dof");
    const bool has_tails = dof != kNotDrawn && std::stod(dof) < 5.0;  // without the key: not restricted
    EXPECT_EQ(!restricted[i].outside_of.empty(), is_rough || has_tails);
    num_outside += !restricted[i].outside_of.empty();
  }
  const StudyPlan plan = MakePlan(some);
  EXPECT_EQ(plan.conditions.size(), 64U - static_cast<size_t>(num_outside));
  EXPECT_EQ(plan.refused.size(), static_cast<size_t>(num_outside));
  EXPECT_THAT(DescribePopulation(plan.identity), HasSubstr("outside of given: sigma_px < 1"));
}

// A parallax of 119 deg, which no baseline gives: an outcome of the trials, for every estimator, that changes
// no other.
TEST(Population, TrialsThatCannotBeSimulatedAreAnOutcome) {
  const Study study =
      DrawnStudy("  number: 16\n  ranges: {scene: plane, motion: sideways, parallax_deg: {any: [2, 119]}}\n");
  const StudyPlan plan = MakePlan(study);
  ASSERT_EQ(plan.conditions.size(), 16U);
  int num_impossible = 0;
  for (const Condition& condition : plan.conditions) {
    const TrialResult result = RunTrialOfDraw(plan, condition, 0);
    const bool is_impossible = condition.levels.back() == "119";
    num_impossible += is_impossible;
    ASSERT_EQ(result.records.size(), plan.study.estimators.size());
    EXPECT_EQ(!result.why_not_simulated.empty(), is_impossible);
    EXPECT_EQ(result.records[0].condition, condition.index);
    EXPECT_EQ(WasSimulated(result.records[0]), !is_impossible);
    EXPECT_EQ(OutcomeInFull(result.records[0], study.failure) == "not_simulated", is_impossible);
    if (is_impossible) {
      EXPECT_THROW(RunTrial(plan, condition, 0), NotSimulated);
    } else {
      EXPECT_EQ(result.records[0].nees, RunTrial(plan, condition, 0).records[0].nees);
    }
  }
  EXPECT_GT(num_impossible, 0);
  EXPECT_LT(num_impossible, 16);
}

// What an author has chosen is an error: a plane that no trial shows enough of.
TEST(Population, OfAGridATrialThatCannotBeSimulatedIsAnError) {
  const StudyPlan plan =
      MakePlan(ParseStudy("data: {scene: plane, motion: sideways, max_rotation_deg: 180, baseline_m: 0.3}\n"
                          "trials: 20\nestimators: [{name: standard}]\n",
                          "study.yaml"));
  EXPECT_THROW(
      {
        for (std::uint32_t trial = 0; trial < 20; ++trial) RunTrialOfDraw(plan, plan.conditions[0], trial);
      },
      NotSimulated);
}

TEST(Population, ChosenDrawsAreThoseOfTheSequence) {
  for (const char* design : {"sobol", "random"}) {
    const std::string text = std::string("  design: ") + design + "\n" + kSmall;
    Study many = DrawnStudy(text);
    Override(&many, "conditions.number", "300");
    const std::vector<PopulationDraw> all = DrawPopulation(many);
    const Study chosen = DrawnStudy(text + "  draws: [299, 5]\n");
    const std::vector<PopulationDraw> draws = DrawPopulation(chosen);
    ASSERT_EQ(draws.size(), 2U);
    EXPECT_EQ(draws[0].number, 5);
    EXPECT_EQ(draws[0].levels, all[5].levels);
    EXPECT_EQ(draws[1].levels, all[299].levels);
    EXPECT_EQ(ToYaml(ParseStudy(ToYaml(chosen), "study.yaml")), ToYaml(chosen));
    EXPECT_THAT(DescribePopulation(MakePlan(chosen).identity), HasSubstr("no sample of the population"));
  }
  EXPECT_THROW(MakePlan(DrawnStudy(std::string("  design: latin_hypercube\n") + kSmall + "  draws: [99]\n")),
               InputError);
  EXPECT_THAT(CatchMessage("  draws: [3, 3]\n  ranges: {scene: plane}\n"), HasSubstr("3 stands there twice"));
  EXPECT_THAT(CatchMessage("  draws: [-1]\n  ranges: {scene: plane}\n"), HasSubstr("'-1' is not allowed"));
}

TEST(Population, AnImpossibleOneIsAnError) {
  EXPECT_THROW(MakePlan(DrawnStudy(
                   "  number: 4\n  ranges: {scene: plane, sigma_px: [1, 2]}\n  given: sigma_px > 5\n")),
               InputError);
}

TEST(Population, SurvivesItsOwnText) {
  const Study study = DrawnStudy(std::string(kSmall) + "  given: [sigma_px <= 2]\n");
  const Study again = ParseStudy(ToYaml(study), "study.yaml");
  EXPECT_EQ(ToYaml(again), ToYaml(study));
  const std::vector<PopulationDraw> draws = DrawPopulation(study), same = DrawPopulation(again);
  for (size_t i = 0; i < draws.size(); ++i) EXPECT_EQ(draws[i].levels, same[i].levels);
  EXPECT_EQ(MakePlan(study).identity, MakePlan(again).identity);
}

TEST(Population, CrossesWithFactors) {
  const Study study = ParseStudy(
      "conditions: {number: 8, ranges: {scene: [room, plane], sigma_px: [0.5, 1], num_matches: 60}}\n"
      "factors: {outlier_ratio: [0, 0.3], standard.num_iterations: [10, 20, 30]}\n"
      "estimators: [{name: standard}]\n",
      "study.yaml");
  const StudyPlan plan = MakePlan(study);
  EXPECT_EQ(plan.conditions.size(), 48U);
  EXPECT_EQ(plan.factor_names, FactorNames(study));
  // Levels of an option meet the same scenes and samples, by different estimators.
  const Condition &first = plan.conditions[0], &second = plan.conditions[1], &other = plan.conditions[3];
  EXPECT_EQ(first.stream_key, second.stream_key);
  EXPECT_NE(first.stream_key, other.stream_key);
  const TrialResult a = RunTrial(plan, first, 0), b = RunTrial(plan, second, 0);
  EXPECT_EQ(a.data.problem.matches.size(), 60U);
  EXPECT_EQ(a.data.problem.matches[7].x2_px, b.data.problem.matches[7].x2_px);
  EXPECT_EQ(ResolveEstimators(study, first.levels)[0].options,
            ResolveEstimators(study, other.levels)[0].options);
  EXPECT_NE(ResolveEstimators(study, first.levels)[0].options,
            ResolveEstimators(study, second.levels)[0].options);
  EXPECT_NE(FindEstimators(plan, first)[0], FindEstimators(plan, second)[0]);
  EXPECT_EQ(FindEstimators(plan, first)[0], FindEstimators(plan, other)[0]);
}

TEST(Population, SetFixesAKey) {
  Study study = DrawnStudy(kSmall);
  Override(&study, "sigma_px", "0.5");
  Override(&study, "scene", "room");
  for (const PopulationDraw& draw : DrawPopulation(study))
    EXPECT_NE(FindLevel(study, draw, "num_boxes"), kNotDrawn);
  EXPECT_EQ(std::ranges::count(ListDrawnKeys(*study.population), "plane_depth_m"), 0);
  EXPECT_THROW(Override(&study, "conditions.size", "3"), InputError);
}

TEST(Population, MessagesNameLineAndKey) {
  EXPECT_THAT(CatchMessage("  ranges: {scene: plane, sigma_px: [3, 0.1]}\n"),
              HasSubstr("sigma_px: two numbers are needed, the first less than the second"));
  EXPECT_THAT(CatchMessage("  ranges: {scene: plane, sigma_px: {log: [0, 1]}}\n"),
              HasSubstr("above 0 and less"));
  EXPECT_THAT(CatchMessage("  ranges: {scene: plane, sigma_px: [1, 2, 3]}\n"), HasSubstr("{any: [...]}"));
  EXPECT_THAT(CatchMessage("  ranges: {scene: plane, num_boxes: [1, 2]}\n"),
              HasSubstr("num_boxes: no draw has this key (needs scene: room)"));
  EXPECT_THAT(CatchMessage("  ranges: {scene: plane, outlier_ratio: [0, 1.5]}\n"), HasSubstr("1.5"));
  EXPECT_THAT(CatchMessage("  ranges: {scene: [plane, planet]}\n"), HasSubstr("'planet' is not allowed"));
  EXPECT_THAT(CatchMessage("  ranges: {scene: [room, plane]}\n", "data: {plane_depth_m: 3}\n"),
              HasSubstr("plane_depth_m"));
  EXPECT_THAT(CatchMessage("  ranges: {scene: match_files}\n", ""), HasSubstr("cannot be drawn"));
  EXPECT_THAT(CatchMessage("  ranges: {scene: plane}\n  given: sigma_px = 2\n"),
              HasSubstr("given: 'sigma_px = 2'"));
  EXPECT_THAT(
      CatchMessage("  ranges: {scene: plane}\n  given: [sigma_px < 2, paralax_deg > 1]\n"),
      HasSubstr("given: paralax_deg > 1: there is no key 'paralax_deg' (did you mean 'parallax_deg'?)"));
  EXPECT_THAT(CatchMessage("  number: 0\n  ranges: {scene: plane}\n"),
              HasSubstr("number: '0' is not allowed"));
  EXPECT_THAT(CatchMessage("  number: 5\n"), HasSubstr("key 'ranges' or 'population' is missing"));
  EXPECT_THAT(CatchMessage("  population: documented_range\n"), HasSubstr("documented_ranges"));
}

TEST(Population, MessagesNameTheLineOfTheKey) {
  const auto message = [](const std::string& key) {
    try {
      ParseStudy("data: {scene: plane}\nconditions:\n  ranges:\n    sigma_px: [0.1, 1]\n    " + key +
                     "\nestimators: [{name: standard}]\n",
                 "study.yaml");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(message("outlier_ratio: [0, 1.5]"), StartsWith("study.yaml:5: outlier_ratio: '1.5'"));
  EXPECT_THAT(message("num_boxes: [1, 2]"), StartsWith("study.yaml:5: ranges: num_boxes: no draw"));
  EXPECT_THAT(message("noise: [gaussian, foo]"), StartsWith("study.yaml:5: noise: 'foo' is not allowed"));
  EXPECT_THAT(message("noise: foo"), StartsWith("study.yaml:5: noise: 'foo' is not allowed"));
  EXPECT_THAT(message("outlier_ratio: log [3, 1]"), StartsWith("study.yaml:5: outlier_ratio: two numbers"));
  EXPECT_THAT(message("noise: any of []"), StartsWith("study.yaml:5: noise: a list"));
}

TEST(EstimatorOptions, AreCheckedAsFactors) {
  const auto message = [](const std::string& factors) -> std::string {
    try {
      ParseStudy("data: {scene: plane}\nfactors: " + factors + "\nestimators: [{name: standard}]\n",
                 "study.yaml");
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(message("{standard.num_iterations: [10, 20]}"), "no error");
  EXPECT_THAT(message("{standrad.num_iterations: [10]}"), HasSubstr("did you mean 'standard'?"));
  EXPECT_THAT(message("{standard.num_iteration: [10]}"), HasSubstr("num_iterations"));
  EXPECT_THAT(message("{standard.num_iterations: [10, 10.0]}"), HasSubstr("10.0"));
  EXPECT_THAT(message("{standard.num_iterations: [10, 10]}"), HasSubstr("stands twice"));
}

// ---- what comes with the program

std::vector<std::string> ReadyMadePopulations() { return NamesIn(SharedFolder::kPopulations); }

Study StudyOfPopulation(const std::string& name, int number) {
  return DrawnStudy("  number: " + std::to_string(number) + "\n  population: " + SourceFolder() +
                        "/populations/" + name + ".yaml" + "\n",
                    "data: {severity: skipped}\n");
}

class ReadyMade : public testing::TestWithParam<std::string> {};

TEST_P(ReadyMade, SaysWhyAndWhence) {
  PopulationText text;
  const Population population =
      LoadPopulation(SourceFolder() + "/populations/" + GetParam() + ".yaml", &text);
  EXPECT_FALSE(text.description.empty());
  EXPECT_FALSE(text.source.empty());
  EXPECT_FALSE(text.reasons.empty());
  const std::vector<std::string> keys = ListDrawnKeys(population);
  for (const auto& [key, reason] : text.reasons) EXPECT_EQ(std::ranges::count(keys, key), 1) << key;
}

// Most trials can be made.
TEST_P(ReadyMade, CanBeSimulated) {
  const StudyPlan plan = MakePlan(StudyOfPopulation(GetParam(), 24), PlanEstimators::kNotMade);
  ASSERT_EQ(plan.conditions.size() + plan.refused.size(), 24U);
  int num_made = 0;
  for (const Condition& condition : plan.conditions) {
    for (std::uint32_t trial = 0; trial < 2; ++trial)
      num_made += RunTrialOfDraw(plan, condition, trial).why_not_simulated.empty();
  }
  EXPECT_GE(num_made, 36);
}

INSTANTIATE_TEST_SUITE_P(Populations, ReadyMade,
                         testing::Values("car", "documented_ranges", "drone", "hand_held_indoor"));

// Whatever the simulator has is drawn, or is left out with a reason.
class DocumentedRanges : public testing::Test {
 protected:
  DocumentedRanges()
      : population_(LoadPopulation(SourceFolder() + "/populations/documented_ranges.yaml", &text_)) {}

  bool IsLeftOut(const std::string& name) const {
    return std::ranges::count(text_.left_out, name, &Settings::value_type::first) > 0;
  }
  template <typename Entry>
  void ExpectAll(const std::string& key, const std::vector<Entry>& registry) {
    const auto drawn = std::ranges::find(population_.keys, key, &DrawnKey::key);
    ASSERT_NE(drawn, population_.keys.end()) << key;
    for (const Entry& entry : registry) {
      const bool is_drawn = std::ranges::count(drawn->range.words, entry.name) > 0;
      EXPECT_TRUE(is_drawn || IsLeftOut(entry.name))
          << key << ": " << entry.name << " is new: add it to populations/documented_ranges.yaml";
      if (!is_drawn) continue;
      const auto model = entry.make();
      for (const Parameter& parameter : model->Parameters()) ExpectKey(parameter.name());
    }
  }
  void ExpectKey(const std::string& key) {
    const std::vector<std::string> keys = ListDrawnKeys(population_);
    EXPECT_TRUE(std::ranges::count(keys, key) > 0 || IsLeftOut(key))
        << key << " is new: add it to populations/documented_ranges.yaml";
  }

  PopulationText text_;
  Population population_;
};

TEST_F(DocumentedRanges, HoldAllThereIs) {
  ExpectAll("scene", SceneRegistry());
  ExpectAll("cameras", CameraRegistry());
  ExpectAll("motion", MotionRegistry());
  ExpectAll("noise", NoiseRegistry());
  ExpectAll("outliers", OutlierRegistry());
  for (const SettingHelp& setting : DescribeSettings({{"scene", "plane"}})) ExpectKey(setting.name);
}

TEST(Populations, AreListed) {
  EXPECT_THAT(ReadyMadePopulations(),
              testing::IsSupersetOf({"car", "documented_ranges", "drone", "hand_held_indoor"}));
}

}  // namespace
}  // namespace rcme
