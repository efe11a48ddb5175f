#include "experiments/statistics/trial_program.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/study/estimator_spec.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

// The text of the program; each %WORD is replaced.
constexpr const char* kProgram =
    R"program(// Trial %TRIAL of condition %CONDITION of the study %STUDY, seed %SEED: the estimator %LABEL on the same
// problem, for a debugger. Made by `rcme replay --emit-cpp`. With an installed rcme (cmake --install), in the
// folder of this file:
//
//   printf 'cmake_minimum_required(VERSION 3.25)\nproject(trial CXX)\nset(CMAKE_CXX_STANDARD 20)\n' > CMakeLists.txt
//   printf 'find_package(rcme REQUIRED)\nadd_executable(trial THIS_FILE)\n' >> CMakeLists.txt
//   printf 'target_link_libraries(trial PRIVATE rcme::experiments)\n' >> CMakeLists.txt
//   cmake -B build -DCMAKE_PREFIX_PATH=WHERE_RCME_IS && cmake --build build
//   gdb --args build/trial
//
// To step through rcme itself, install a build of the preset `dev`.
#include <cstdio>

#include "estimator/estimator_registry.h"
#include "peers/peer_registry.h"
#include "stats/random.h"

namespace {

// x1, y1, x2, y2 of each match, px.
constexpr double kMatches[][4] = {
%MATCHES};

rcme::MotionProblem MakeProblem() {
  rcme::MotionProblem problem;
  for (const auto& m : kMatches) problem.matches.push_back({{m[0], m[1]}, {m[2], m[3]}});
  problem.camera1 = {%CAMERA1};
  problem.camera2 = {%CAMERA2};
  problem.sigma_px = %SIGMA;
  problem.noise_scale = {%SCALES};
  problem.match_quality = {%QUALITIES};
  return problem;
}

}  // namespace

int main() {
  rcme::AddPeers();
  rcme::AddOutsideEstimators();
  const auto estimator = rcme::MakeEstimator(%NAME, {%OPTIONS});
  const rcme::MotionProblem problem = MakeProblem();
  rcme::RandomStream rng({%STREAM});  // seed, condition, trial, purpose
  const rcme::MotionEstimate estimate = estimator->Estimate(problem, rng);  // break here
  std::printf("%s: %s\n", rcme::StatusName(estimate.status).c_str(), estimate.message.c_str());

  // What `rcme replay` found: %OUTCOME
  bool is_same = rcme::StatusName(estimate.status) == %STATUS;
%CHECKS  std::printf("%s\n", is_same ? "the same answer as in the trial" : "ANOTHER answer than in the trial");
  return is_same ? 0 : 1;
}
)program";

// Formats a number with all its bits.
std::string Bits(double x) { return fmt::format("{:a}", x); }

std::string CppText(const std::string& text) {
  std::string literal = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') literal += '\\';
    literal += c;
  }
  return literal + "\"";
}

std::string CameraText(const Camera& camera) {
  return fmt::format("{}, {}, {}, {}, {}, {}", Bits(camera.fx), Bits(camera.fy), Bits(camera.cx),
                     Bits(camera.cy), camera.width, camera.height);
}

// Makes the comparison of the motion, a line per number; empty for a refusal.
std::string CheckLines(const MotionEstimate& estimate) {
  if (estimate.status != MotionStatus::kOk) return "";
  std::string lines;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c)
      lines += fmt::format("  is_same = is_same && estimate.cam2_from_cam1.R({}, {}) == {};\n", r, c,
                           Bits(estimate.cam2_from_cam1.R(r, c)));
    lines += fmt::format("  is_same = is_same && estimate.cam2_from_cam1.t({}) == {};\n", r,
                         Bits(estimate.cam2_from_cam1.t(r)));
  }
  return lines;
}

using Replacements = std::vector<std::pair<std::string, std::string>>;

// Replaces every name in the template by its text. The texts themselves are not searched for names.
std::string FillIn(const Replacements& texts) {
  std::string filled;
  for (std::string_view rest = kProgram; !rest.empty();) {
    const auto begins = [&](const auto& text) { return rest.starts_with("%" + text.first); };
    const auto found = std::ranges::find_if(texts, begins);
    filled += found == texts.end() ? std::string(1, rest.front()) : found->second;
    rest.remove_prefix(found == texts.end() ? 1 : found->first.size() + 1);
  }
  return filled;
}

}  // namespace

std::string TrialAsCpp(const StudyPlan& plan, const Condition& condition, const TrialResult& result,
                       size_t estimator) {
  if (!result.why_not_simulated.empty())
    throw InputError("--emit-cpp: the trial was not simulated: " + result.why_not_simulated);
  const EstimatorSpec spec = ResolveEstimators(plan.study, condition.levels).at(estimator);
  if (spec.name == "process") {
    throw InputError(fmt::format(
        "--emit-cpp: {} is a process of its own; `rcme export` writes its problems for a debugger there",
        spec.label));
  }
  const MotionProblem& problem = result.data.problem;
  const MotionEstimate& estimate = result.estimates.at(estimator);
  std::string matches, options, scales, qualities;
  for (const Correspondence& match : problem.matches)
    matches += fmt::format("    {{{}, {}, {}, {}}},\n", Bits(match.x1_px.x()), Bits(match.x1_px.y()),
                           Bits(match.x2_px.x()), Bits(match.x2_px.y()));
  for (const auto& [name, value] : spec.options)
    options += fmt::format("{}{{{}, {}}}", options.empty() ? "" : ", ", CppText(name), CppText(value));
  for (const double scale : problem.noise_scale) scales += (scales.empty() ? "" : ", ") + Bits(scale);
  for (const double quality : problem.match_quality)
    qualities += (qualities.empty() ? "" : ", ") + Bits(quality);
  const StreamName name = NameOfTrial(plan, condition, result.problem.trial);
  return FillIn({{"TRIAL", fmt::format("{}", result.problem.trial)},
                 {"CONDITION", fmt::format("{}", condition.index)},
                 {"STUDY", plan.study.name},
                 {"SEED", fmt::format("{}", plan.study.seed)},
                 {"LABEL", spec.label},
                 {"MATCHES", matches},
                 {"CAMERA1", CameraText(problem.camera1)},
                 {"CAMERA2", CameraText(problem.camera2)},
                 {"SIGMA", Bits(problem.sigma_px)},
                 {"SCALES", scales},
                 {"QUALITIES", qualities},
                 {"NAME", CppText(spec.name)},
                 {"OPTIONS", options},
                 {"STREAM", fmt::format("{}u, {}u, {}u, {}u", name.seed, name.condition, name.trial,
                                        static_cast<std::uint32_t>(StreamPurpose::kSampling))},
                 {"OUTCOME", StatusName(estimate.status)},
                 {"STATUS", CppText(StatusName(estimate.status))},
                 {"CHECKS", CheckLines(estimate)}});
}

}  // namespace rcme
