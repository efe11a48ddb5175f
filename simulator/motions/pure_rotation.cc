
#include "simulator/motions/motions.h"
#include "stats/constants.h"

namespace rcme {
namespace {

class PureRotation : public MotionModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {Parameter::Real("max_rotation_deg", &max_rotation_deg_, {0.0, 180.0}, "deg",
                            "greatest rotation, uniform from 0")};
  }
  Motion Draw(RandomStream& rng) const override {
    return {{DrawRotation(RadFromDeg(max_rotation_deg_), rng), Eigen::Vector3d::UnitX()}, 0.0};
  }

 private:
  double max_rotation_deg_ = 10.0;
};

}  // namespace

std::unique_ptr<MotionModel> MakePureRotation() { return std::make_unique<PureRotation>(); }

}  // namespace rcme
