// Noise and wrong matches drawn anew for real pairs whose right matches have been put where they belong.
#pragma once

#include <memory>
#include <vector>

#include "experiments/data/data_source.h"
#include "parameters/parameter.h"
#include "simulator/noise_model.h"
#include "stats/student_scales.h"

namespace rcme {

// A match whose Sampson distance from the file's true motion is below this is exact, and so right: a wrong
// one is as near with a probability of about 1e-5.
inline constexpr double kExactPx = 1e-3;

enum class WrongMatches { kKept, kShuffled };

// What a `data:` block says of it. The noise of a key point has the variance noise_px^2, of which a share is
// that of its near neighbours (one point found twice), a share that of far ones (one piece of texture), and
// the rest its own. It is normal, or Student's t: then all four coordinates of a match, whose key points are
// precise or not, are large together (stats/student_scales.h). Where a pair states how noisy its matches are,
// each one's noise is as many times as large (MotionProblem::noise_scale), and that of a whole pair by its
// level (MatchFile::noise_level).
//
// Right matches are those that were found near; what is drawn for them stays as near, and a wrong match stays
// wrong.
struct RedrawSettings {
  double noise_px = 0.0;     // 0: nothing is drawn, matches are those of the files
  double student_dof = 0.0;  // 0: normal
  double within_px = 0.0;    // of a right match's Sampson distance from the truth; 0: any
  double near_share = 0.0, far_share = 0.0;
  double far_length_px = 40.0;
  WrongMatches wrong = WrongMatches::kShuffled;
};
std::vector<Parameter> Parameters(RedrawSettings& settings);

// Draws for pairs as the settings say. Const and shared by threads.
class Redraw {
 public:
  // Throws InputError: shares that are together more than 1.
  explicit Redraw(const RedrawSettings& settings);
  bool IsOn() const { return settings_.noise_px > 0.0; }
  // Says which matches of an exact pair are right. Throws InputError that names the pair without a true
  // motion.
  static void Label(TrialData* exact);
  // Noise for the right matches of an exact pair; the second points of the wrong ones are dealt out again
  // among them, which keeps where wrong matches lie in either image and breaks what they have in common.
  // Noise, and the distance within which right matches stay, are `noise_level` times those of the settings.
  TrialData Draw(const TrialData& exact, const StreamName& trial_name, double noise_level = 1.0) const;

 private:
  std::vector<Correspondence> WithNoise(const TrialData& exact, const std::vector<size_t>& right,
                                        double noise_level, RandomStream& rng) const;
  void DealOutAgain(const TrialData& exact, const std::vector<size_t>& wrong, double noise_level,
                    RandomStream& rng, std::vector<Correspondence>* matches) const;

  RedrawSettings settings_;
  StudentScales scales_;
  std::vector<std::shared_ptr<const NoiseModel>> laws_;  // whose sum, times a scale, is the noise
};

}  // namespace rcme
