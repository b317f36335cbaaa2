// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/report/checks_in_place.h"

#include <Eigen/Geometry>
#include <numbers>

namespace palpate::certify {

namespace {

/// Nodal forces after x = A X. N
Eigen::Matrix3Xd forcesAfter(const solver::FeModel& body, const Mat3& A) {
  Eigen::VectorXd u(3 * body.nodeCount());
  for (int i = 0; i < body.nodeCount(); ++i) {
    const Vec3& X = body.nodes()[static_cast<std::size_t>(i)];
    u.segment<3>(3 * i) = A * X - X;
  }
  const Eigen::VectorXd f = body.internalForce(u);
  return Eigen::Map<const Eigen::Matrix3Xd>(f.data(), 3, body.nodeCount());
}

}  // namespace

ChecksInPlace checkedInPlace(const query::Organ& organ) {
  const solver::FeModel& held = organ.body;
  const solver::FeModel body(held.nodes(), held.tetrahedra(), held.fixedNodes(), held.material());
  const Mat3 turn =
      Eigen::AngleAxisd(std::numbers::pi / 6.0, Vec3(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
  Mat3 stretch = Mat3::Identity();
  stretch(0, 0) = 1.1;
  const Eigen::Matrix3Xd turned = forcesAfter(body, turn), stretched = forcesAfter(body, stretch);
  return {turned.colwise().norm().maxCoeff() / stretched.colwise().norm().maxCoeff(),
          stretched.rowwise().sum().norm() / stretched.colwise().norm().sum()};
}

}  // namespace palpate::certify
