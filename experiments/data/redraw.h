// Noise and wrong matches drawn anew for real pairs whose right matches have been put where they belong.
#pragma once

#include <memory>
#include <vector>

#include "experiments/data/data_source.h"
#include "parameters/parameter.h"
#include "simulator/noise_model.h"

namespace rcme {

// A match whose Sampson distance from the file's true motion is below this is exact, and so right: a wrong
// one is as near with a probability of about 1e-5.
inline constexpr double kExactPx = 1e-3;

enum class WrongMatches { kKept, kShuffled };

// What a `data:` block says of it. The noise of a key point has the variance noise_px^2, of which a share is
// that of its near neighbours (one point found twice), a share that of far ones (one piece of texture), and
// the rest its own. It is normal, or Student's t: then all four coordinates of a match, whose key points are
// precise or not, are large together, by the root of (m - 2) / chi-square with m degrees of freedom. Where a
// pair states how noisy its matches are, each one's noise is as many times as large
// (MotionProblem::noise_scale).
struct RedrawSettings {
  double noise_px = 0.0;  // 0: nothing is drawn, matches are those of the files
  int student_dof = 0;    // 0: normal; else 3 or more
  double near_share = 0.0, far_share = 0.0;
  double far_length_px = 40.0;
  WrongMatches wrong = WrongMatches::kShuffled;
};
std::vector<Parameter> Parameters(RedrawSettings& settings);

// Draws for pairs as the settings say. Const and shared by threads.
class Redraw {
 public:
  // Throws InputError: shares that are together more than 1, one or two degrees of freedom.
  explicit Redraw(const RedrawSettings& settings);
  bool IsOn() const { return settings_.noise_px > 0.0; }
  // Says which matches of an exact pair are right. Throws InputError that names the pair without a true
  // motion.
  static void Label(TrialData* exact);
  // Noise for the right matches of an exact pair; the second points of the wrong ones are dealt out again
  // among them, which keeps where wrong matches lie in either image and breaks what they have in common.
  TrialData Draw(const TrialData& exact, const StreamName& trial_name) const;

 private:
  RedrawSettings settings_;
  std::vector<std::shared_ptr<const NoiseModel>> laws_;  // whose sum is the noise
};

}  // namespace rcme
