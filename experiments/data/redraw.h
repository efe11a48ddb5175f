// Redraws noise and wrong matches for real pairs whose right matches have been moved to exact positions.
#pragma once

#include <memory>
#include <vector>

#include "experiments/data/data_source.h"
#include "parameters/parameter.h"
#include "simulator/noise_model.h"
#include "stats/student_scales.h"

namespace rcme {

// A match with a smaller Sampson distance from the true motion of its file counts as exact and right. A
// wrong match is so near with a probability of about 1e-5.
inline constexpr double kExactPx = 1e-3;

enum class WrongMatches { kKept, kShuffled };

// The settings in a `data:` block. The noise of a key point has variance noise_px^2. near_share of it is
// common to near neighbours (one point detected twice), far_share to distant ones (one region of texture),
// and the rest is independent. The noise is normal, or Student's t; then all four coordinates of a match are
// scaled together, because its key points are precise or not (stats/student_scales.h). The noise is
// multiplied by the relative noise of each match if the pair states it (MotionProblem::noise_scale), and by
// the level of the pair (MatchFile::noise_level).
//
// Right matches are those that were found near the epipolar line. With within_px they stay as near when
// redrawn, and wrong matches stay wrong.
struct RedrawSettings {
  double noise_px = 0.0;     // 0: nothing is redrawn
  double student_dof = 0.0;  // 0: normal
  double within_px = 0.0;    // limit of a right match's Sampson distance from the truth; 0: none
  double near_share = 0.0, far_share = 0.0;
  double far_length_px = 40.0;
  WrongMatches wrong = WrongMatches::kShuffled;
};
std::vector<Parameter> Parameters(RedrawSettings& settings);

// Redraws pairs by the settings. Const, and shared by threads.
class Redraw {
 public:
  // Throws InputError if the shares sum to more than 1.
  explicit Redraw(const RedrawSettings& settings);
  bool IsOn() const { return settings_.noise_px > 0.0; }
  // Marks which matches of an exact pair are right. Throws InputError that names the pair if it has no true
  // motion.
  static void Label(TrialData* exact);
  // Adds noise to the right matches of an exact pair. The second points of the wrong matches are permuted
  // among them: this keeps the distribution of wrong matches in each image but breaks their dependence.
  // Noise and within_px are multiplied by `noise_level`.
  TrialData Draw(const TrialData& exact, const StreamName& trial_name, double noise_level = 1.0) const;

 private:
  std::vector<Correspondence> WithNoise(const TrialData& exact, const std::vector<size_t>& right,
                                        double noise_level, RandomStream& rng) const;
  void DealOutAgain(const TrialData& exact, const std::vector<size_t>& wrong, double noise_level,
                    RandomStream& rng, std::vector<Correspondence>* matches) const;

  RedrawSettings settings_;
  StudentScales scales_;
  std::vector<std::shared_ptr<const NoiseModel>> laws_;  // their sum, times a scale, is the noise
};

}  // namespace rcme
