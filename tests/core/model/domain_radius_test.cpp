// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/data/model_view.h"
#include "core/model/contact_response.h"

namespace palpate {
namespace {

/// d_max between contact positions that have these.
class DomainRadius {
 public:
  explicit DomainRadius(std::vector<double> radii)
      : domain_(std::move(radii)), series_(domain_.size(), 1.0), force_(domain_.size() * 9 * 3, 0.0) {
    view_.contact_domain_radius = domain_;
    view_.contact_series_radius = series_;
    view_.contact_force = force_;
    attributes_.parameters = Parameters::kDisplacement;
    attributes_.order = 1;
    attributes_.force_order = 2;
    attributes_.reference_displacement = 1e-3;
  }
  /// @param weights  of the first positions
  [[nodiscard]] double at(const std::vector<double>& weights) const {
    PositionMix mix;
    mix.count = static_cast<int>(weights.size());
    for (std::size_t b = 0; b < weights.size(); ++b) {
      mix.position[b] = static_cast<std::int32_t>(b);
      mix.weight[b] = weights[b];
    }
    return ContactResponse(view_, attributes_).domainRadius(mix);
  }

 private:
  std::vector<double> domain_, series_, force_;
  ModelView view_;
  ModelAttributes attributes_;
};

TEST(DomainRadius, IsEachPositionsOwnAtThePosition) {
  const DomainRadius radius({0.002, 0.005, 0.009});
  EXPECT_NEAR(radius.at({1.0, 0.0, 0.0}), 0.002, 1e-15);
  EXPECT_NEAR(radius.at({0.0, 1.0, 0.0}), 0.005, 1e-15);
  EXPECT_NEAR(radius.at({0.0, 0.0, 1.0}), 0.009, 1e-15);
  EXPECT_NEAR(radius.at({1.0}), 0.002, 1e-15);
}

TEST(DomainRadius, IsWhereTheMixedErrorIsThatOfEachPosition) {
  const DomainRadius radius({0.002, 0.005, 0.009});
  const double at = radius.at({0.5, 0.3, 0.2});
  const auto error = [&](double own) { return std::pow(at / own, 4.0); };
  EXPECT_NEAR(0.5 * error(0.002) + 0.3 * error(0.005) + 0.2 * error(0.009), 1.0, 1e-12);
  EXPECT_GT(at, 0.002);
  EXPECT_LT(at, 0.5 * 0.002 + 0.3 * 0.005 + 0.2 * 0.009);
}

TEST(DomainRadius, IsContinuousOverAnEdge) {
  const DomainRadius both({0.002, 0.005}), three({0.002, 0.005, 0.0});
  EXPECT_DOUBLE_EQ(three.at({0.4, 0.6, 0.0}), both.at({0.4, 0.6}));
  EXPECT_EQ(three.at({0.4, 0.5, 0.1}), 0.0) << "one position is trusted nowhere";
}

TEST(DomainRadius, IsNothingWithoutPositions) {
  EXPECT_EQ(DomainRadius({0.002}).at({}), 0.0);
}

}  // namespace
}  // namespace palpate
