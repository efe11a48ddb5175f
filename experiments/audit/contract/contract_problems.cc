#include "experiments/audit/contract/contract_problems.h"

#include <fmt/format.h>

#include <functional>

#include "experiments/data/make_data.h"
#include "simulator/scene_registry.h"
#include "stats/constants.h"

namespace rcme {
namespace {

struct Shape {
  int num_matches;
  double outlier_ratio, sigma_px;
};

ContractProblem Simulate(const std::string& name, const std::string& scene, const Shape& shape,
                         const StreamName& stream) {
  const DataSources sources = MakeDataSources({{"scene", scene},
                                               {"num_matches", fmt::format("{}", shape.num_matches)},
                                               {"outlier_ratio", fmt::format("{}", shape.outlier_ratio)},
                                               {"sigma_px", fmt::format("{}", shape.sigma_px)},
                                               {"severity", "skipped"}});
  TrialData data = sources.sources.front().second->Make(stream);
  return {name, std::move(data.problem), stream, false, data.truth.cam2_from_cam1_true};
}

using Change = std::function<void(MotionProblem&)>;

struct Spoiling {
  std::string name;
  Change change;
  bool has_no_motion;
};

// Keeps the first `num_distinct` matches and repeats them.
Change Repeat(size_t num_distinct) {
  return [num_distinct](MotionProblem& problem) {
    for (size_t i = num_distinct; i < problem.matches.size(); ++i)
      problem.matches[i] = problem.matches[i % num_distinct];
  };
}

Change Keep(size_t num_matches) {
  return [num_matches](MotionProblem& problem) { problem.matches.resize(num_matches); };
}

Change SetSigma(double sigma_px) {
  return [sigma_px](MotionProblem& problem) { problem.sigma_px = sigma_px; };
}

Change SetScale(double scale, size_t at = 3) {
  return [scale, at](MotionProblem& problem) {
    problem.noise_scale.assign(problem.matches.size(), 1.0);
    problem.noise_scale.at(at) = scale;
  };
}

template <typename Work>
Change ForEachMatch(Work work) {
  return [work](MotionProblem& problem) {
    for (Correspondence& match : problem.matches) work(match);
  };
}

std::vector<Spoiling> Spoilings() {
  using P = MotionProblem;
  using C = Correspondence;
  return {
      {"no match", Keep(0), true},
      {"one match", Keep(1), true},
      {"four matches", Keep(4), true},
      {"five matches", Keep(5), false},
      {"seven matches", Keep(7), false},
      {"eight matches", Keep(8), false},
      {"the same match 60 times", Repeat(1), true},
      {"four matches, 15 times each", Repeat(4), true},
      {"every match twice", Repeat(30), false},
      {"NaN in image 1", [](P& p) { p.matches[3].x1_px.x() = kNaN; }, true},
      {"NaN in image 2", [](P& p) { p.matches[59].x2_px.y() = kNaN; }, true},
      {"infinity in image 1", [](P& p) { p.matches[0].x1_px.y() = kInfinity; }, true},
      {"minus infinity in image 2", [](P& p) { p.matches[3].x2_px.x() = -kInfinity; }, true},
      {"NaN everywhere", ForEachMatch([](C& m) { m.x1_px.setConstant(kNaN), m.x2_px.setConstant(kNaN); }),
       true},
      {"one coordinate of 1e300", [](P& p) { p.matches[3].x2_px.x() = 1e300; }, false},
      {"coordinates of 1e150", ForEachMatch([](C& m) { m.x1_px *= 1e150, m.x2_px *= 1e150; }), false},
      {"coordinates of 1e-300", ForEachMatch([](C& m) { m.x1_px *= 1e-300, m.x2_px *= 1e-300; }), false},
      {"points of image 1 on a line", ForEachMatch([](C& m) { m.x1_px.y() = 2.0 * m.x1_px.x() + 3.0; }),
       false},
      {"points of both images on lines",
       ForEachMatch([](C& m) { m.x1_px.y() = 2.0 * m.x1_px.x(), m.x2_px.x() = 320.0; }), false},
      {"points of image 2 in one spot", ForEachMatch([](C& m) { m.x2_px << 320.0, 240.0; }), false},
      {"the same image twice", ForEachMatch([](C& m) { m.x2_px = m.x1_px; }), false},
      {"focal length 0", [](P& p) { p.camera1.fx = 0.0; }, true},
      {"focal length NaN", [](P& p) { p.camera2.fy = kNaN; }, true},
      {"infinite principal point", [](P& p) { p.camera2.cx = kInfinity; }, true},
      {"sigma 0", SetSigma(0.0), true},
      {"negative sigma", SetSigma(-0.5), true},
      {"sigma NaN", SetSigma(kNaN), true},
      {"infinite sigma", SetSigma(kInfinity), true},
      {"fewer noise scales than matches", [](P& p) { p.noise_scale.assign(p.matches.size() - 1, 1.0); },
       true},
      {"more noise scales than matches", [](P& p) { p.noise_scale.assign(p.matches.size() + 1, 1.0); }, true},
      {"a noise scale of 0", SetScale(0.0), true},
      {"a negative noise scale", SetScale(-1.0), true},
      {"a noise scale that is NaN", SetScale(kNaN, 0), true},
      {"an infinite noise scale", SetScale(kInfinity), true},
      {"noise scales of 1e-6 and 1e6",
       [](P& p) {
         for (size_t i = 0; i < p.matches.size(); ++i) p.noise_scale.push_back(i % 2 == 0 ? 1e-6 : 1e6);
       },
       false},
      {"sigma 1e-300", SetSigma(1e-300), false},
      {"sigma 1e300", SetSigma(1e300), false},
  };
}

}  // namespace

std::vector<ContractProblem> OrdinaryProblems(std::uint64_t seed) {
  std::vector<ContractProblem> problems;
  for (const SceneEntry& scene : SceneRegistry()) {
    for (const Shape& shape : {Shape{200, 0.0, 0.5}, {200, 0.6, 0.5}, {60, 0.3, 2.0}, {12, 0.0, 0.5}}) {
      const std::string name = fmt::format("{}, {} matches, {:g} % wrong", scene.name, shape.num_matches,
                                           100.0 * shape.outlier_ratio);
      const auto index = static_cast<std::uint32_t>(problems.size());
      problems.push_back(Simulate(name, scene.name, shape, {seed, 0, index, 0}));
      problems.back().cam2_from_cam1_true.reset();  // any answer will do
    }
  }
  return problems;
}

std::vector<ContractProblem> EasyProblems(std::uint64_t seed) {
  std::vector<ContractProblem> problems;
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    problems.push_back(
        Simulate(fmt::format("easy {}", trial), "uniform_volume", {100, 0.0, 0.1}, {seed, 1, trial, 0}));
  }
  return problems;
}

std::vector<ContractProblem> BadProblems(std::uint64_t seed) {
  std::vector<ContractProblem> problems;
  const ContractProblem good = Simulate("", "uniform_volume", {60, 0.0, 0.5}, {seed, 2, 0, 0});
  for (const Spoiling& spoiling : Spoilings()) {
    ContractProblem problem = good;
    problem.name = spoiling.name;
    problem.cam2_from_cam1_true.reset();
    problem.has_no_motion = spoiling.has_no_motion;
    spoiling.change(problem.problem);
    problems.push_back(std::move(problem));
  }
  return problems;
}

ContractProblem LargeProblem(std::uint64_t seed) {
  ContractProblem problem =
      Simulate("100000 matches, 30 % wrong", "uniform_volume", {100'000, 0.3, 0.5}, {seed, 3, 0, 0});
  problem.cam2_from_cam1_true.reset();
  return problem;
}

}  // namespace rcme
