// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>  // cross products

namespace palpate {

using Vec3 = Eigen::Vector3d;               ///< a point or vector, 3
using Vec4 = Eigen::Vector4d;               ///< 4
using Vec6 = Eigen::Matrix<double, 6, 1>;   ///< 6
using Mat3 = Eigen::Matrix3d;               ///< a tensor, 3 x 3
using Vec2 = Eigen::Vector2d;               ///< along two tangents, 2
using Mat2 = Eigen::Matrix2d;               ///< between tangents, 2 x 2
using Mat32 = Eigen::Matrix<double, 3, 2>;  ///< vectors along two tangents, 3 x 2
using Mat23 = Eigen::Matrix<double, 2, 3>;  ///< 2 x 3

}  // namespace palpate
