#include "experiments/real/answer/refusal_advice.h"

#include <fmt/format.h>

#include <memory>

#include "estimator/conform/conform_estimator.h"
#include "experiments/core/text/program_name.h"
#include "experiments/core/text/shell_word.h"
#include "parameters/input_error.h"
#include "parameters/settings.h"

namespace rcme {
namespace {

constexpr const char* kCheckCalibration =
    "check the intrinsics (--K, or # K1_fx_fy_cx_cy) and that x1,y1 are of image 1, x2,y2 of image 2";
constexpr const char* kWiderBaseline =
    "take two images from places further apart: these matches determine the rotation but no direction";

// Suggests "more samples: --set num_iterations=2000": ten times the current number, at most what the option
// allows.
void AddMoreSamples(const EstimatorSpec& spec, std::vector<std::string>* advice) {
  const std::unique_ptr<EstimatorModel> model = Configure(spec);
  const std::optional<Effort> effort = model->EffortOption();
  if (!effort) return;
  const std::vector<Parameter> parameters = model->Parameters();
  const Parameter& option = FindParameter(parameters, effort->option);
  long long samples = 0;
  if (!ParseInteger(option.Value(), &samples)) return;
  const std::string more = fmt::format("{}", 10 * samples);
  try {
    option.SetFromText(more);
  } catch (const InputError&) {
    return;  // already at the option's limit, or nearly
  }
  advice->push_back(fmt::format("more samples: --set {}={}", effort->option, more));
}

void AddOtherEstimator(const EstimatorSpec& spec, std::vector<std::string>* advice) {
  if (spec.name != "rcme_calibrated")
    advice->push_back(
        "another estimator: --estimator rcme_calibrated estimates the noise and states its doubts");
}

// "rcme check-estimator NAME" with the options that differ from their defaults, to be pasted into a shell.
std::string FormatCheckCommand(const EstimatorSpec& spec) {
  std::string command = QuoteForShell(CommandName()) + " check-estimator " + QuoteForShell(spec.name);
  const Settings defaults = DefaultEstimator(spec.name).options;
  for (const auto& [option, value] : spec.options) {
    if (FindSetting(defaults, option) != value) command += " --set " + QuoteForShell(option + "=" + value);
  }
  return command;
}

}  // namespace

std::vector<std::string> AdviceFor(const MotionEstimate& estimate, const EstimatorSpec& spec) {
  std::vector<std::string> advice;
  switch (estimate.status) {
    case MotionStatus::kOk:
    case MotionStatus::kNotSimulated:
    case MotionStatus::kTruthInDoubt:
      break;
    case MotionStatus::kNoCandidate:
      AddMoreSamples(spec, &advice);
      advice.push_back("a greater noise level, if key points are less exact than assumed: --sigma 2");
      AddOtherEstimator(spec, &advice);
      advice.push_back(kCheckCalibration);
      break;
    case MotionStatus::kRefinementDiverged:
      AddMoreSamples(spec, &advice);
      AddOtherEstimator(spec, &advice);
      advice.push_back(kWiderBaseline);
      break;
    case MotionStatus::kTooFewExplained:
      advice.push_back("accept a smaller share of the matches: --set least_explained_share=0");
      AddMoreSamples(spec, &advice);
      break;
    case MotionStatus::kTooFewMatches:
      advice.push_back("more matches: a looser ratio test, more key points, or images that overlap more");
      break;
    case MotionStatus::kDegenerateMatches:
      advice.push_back("matches from all over both images: these lie on a line or repeat each other");
      advice.push_back(kCheckCalibration);
      break;
    case MotionStatus::kDirectionNotObservable:
    case MotionStatus::kRotationOnly:
    case MotionStatus::kTooLittleParallax:
      advice.push_back(kWiderBaseline);
      break;
    case MotionStatus::kNotBetterThanChance:
      advice.push_back("images that overlap more, or better matches: chance gives as many agreeing ones");
      AddMoreSamples(spec, &advice);
      advice.push_back(kCheckCalibration);
      break;
    case MotionStatus::kTooUncertain:
      advice.push_back(
          fmt::format("see the motion with its probability: --set {}",
                      spec.name == kConformEstimator ? "accept_rule=ignore" : "max_failure_probability=1"));
      advice.push_back("more matches, or images from places further apart");
      break;
    case MotionStatus::kPlanarScene:
      advice.push_back("see the motion all the same: --set planar_scenes=answered");
      advice.push_back("matches off the plane, or a third image: a plane has two motions that fit");
      break;
    case MotionStatus::kLibraryError:
    case MotionStatus::kTimedOut:
    case MotionStatus::kNoAnswer:
    case MotionStatus::kUnreadableAnswer:
    case MotionStatus::kInvalidMotion:
    case MotionStatus::kInvalidCovariance:
      advice.push_back(fmt::format("what it should answer, and what it does: {}", FormatCheckCommand(spec)));
      AddOtherEstimator(spec, &advice);
      break;
    case MotionStatus::kInvalidInput:
      advice.push_back(kCheckCalibration);
      break;
  }
  return advice;
}

}  // namespace rcme
