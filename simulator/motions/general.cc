
#include "simulator/motions/motions.h"
#include "stats/constants.h"

namespace rcme {
namespace {

class GeneralMotion : public MotionModel {
 public:
  explicit GeneralMotion(const Baseline& baseline) : baseline_(baseline) {}

  std::vector<Parameter> Parameters() override {
    std::vector<Parameter> all = {Parameter::Real("max_rotation_deg", &max_rotation_deg_, {0.0, 180.0}, "deg",
                                                  "greatest rotation, uniform from 0")};
    const std::vector<Parameter> more = rcme::Parameters(baseline_);
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  Baseline* MutableBaseline() override { return &baseline_; }

  Motion Draw(RandomStream& rng) const override {
    const Eigen::Matrix3d R = DrawRotation(RadFromDeg(max_rotation_deg_), rng);
    return {{R, DrawDirection(rng)}, baseline_.Length()};
  }

 private:
  double max_rotation_deg_ = 10.0;
  Baseline baseline_;
};

}  // namespace

std::unique_ptr<MotionModel> MakeGeneralMotion() { return std::make_unique<GeneralMotion>(Baseline()); }

std::unique_ptr<MotionModel> MakeVanishingBaseline() {
  return std::make_unique<GeneralMotion>(Baseline{0.5, 0.05});
}

}  // namespace rcme
