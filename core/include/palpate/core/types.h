// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>  // cross products

namespace palpate {

using Vec3 = Eigen::Vector3d;  ///< a point or vector, 3
using Mat3 = Eigen::Matrix3d;  ///< a tensor, 3 x 3

}  // namespace palpate
