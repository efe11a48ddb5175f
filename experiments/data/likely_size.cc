#include "experiments/data/likely_size.h"

#include <algorithm>
#include <cmath>

namespace rcme {

std::array<int, 2> LikelySize(const Camera& camera, const std::vector<Correspondence>& matches,
                              Eigen::Vector2d Correspondence::*x_px) {
  Eigen::Vector2d size(2.0 * camera.cx + 1.0, 2.0 * camera.cy + 1.0);
  for (const Correspondence& match : matches)
    size = size.cwiseMax((match.*x_px + Eigen::Vector2d::Constant(0.5)).eval());
  const auto whole = [](double length) {
    return static_cast<int>(std::clamp(std::ceil(length), 1.0, kMaxImageLength));
  };
  return {whole(size.x()), whole(size.y())};
}

}  // namespace rcme
