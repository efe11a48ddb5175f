#include "estimator/calibrated/noise_choice.h"

namespace rcme {
namespace {

constexpr int kNoiseSteps = 6;
constexpr double kLeastGain = 2.0;  // nats

}  // namespace

void ChooseNoiseLaw(const MatchBlocks& matches, const MixturePrior& prior, ExplainedMode* answer) {
  Mode mode = answer->mode;
  mode.mixture.noise = kStudent15;
  mode.mixture.scale *= kStudent15.scale_of_gaussian / answer->mode.mixture.noise.scale_of_gaussian;
  if (!FitMode(matches, prior, kNoiseSteps, &mode)) return;
  if (!(mode.log_likelihood > answer->mode.log_likelihood + kLeastGain)) return;
  answer->explanation = Explain(matches, mode);
  answer->mode = std::move(mode);
}

}  // namespace rcme
