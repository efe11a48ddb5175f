#pragma once

#include <Eigen/Core>

#include "estimator/geometry/essential_matrix.h"

namespace rcme {

// J_p = dp/df (5x9) of the step from f to the motion by differentiating the singular value decomposition
// itself, the paper's other way to eq::cov_p (Papadopoulo & Lourakis 2000). `projection` is that of the noisy
// 3x3 matrix Matricize(f), f a unit vector in rays, with its actual singular values. `pose` is one of its
// four motions, PosesFromEssential(projection). Tangent [rotation, direction] around `pose`.
//
// This is the derivative of the step actually taken, to first order in df but at any distance from the
// essential matrices. At an essential matrix it equals MotionJacobian(pose), up to the sign of f. Infinite if
// the second singular value equals the third in magnitude: the direction is then not determined.
Eigen::Matrix<double, 5, 9> MotionJacobianBySvd(const EssentialProjection& projection,
                                                const RelativePose& pose);

}  // namespace rcme
