// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "core/base/types.h"

namespace palpate {

/// N smooth functions over one triangle, from their values and gradients at its corners and the middles of its edges: the
/// cubic of Hsieh, Clough and Tocher over each of the four triangles between these points. The derivative across an edge, in
/// the middle of each half, is that of the quadratic through the three gradients on the edge, and so the same from both
/// sides: C1 over a plane. Exact for cubics.
///   R. W. Clough, J. L. Tocher, Finite element stiffness matrices for analysis of plates in bending, 1965; the Bezier form
///   after G. Farin, Triangular Bernstein-Bezier patches, CAGD 3 (1986) 83-127.
template <int N>
class SmoothCubic {
 public:
  using Value = Eigen::Matrix<double, N, 1>;
  /// Value, then derivatives along X1 - X0 and X2 - X0.
  using Point = std::array<Value, 3>;
  struct Jet {
    Value value;
    std::array<Value, 3>
        slope;  ///< d/dlambda; only along changes that keep the sum of lambda do they have a meaning
  };

  std::array<Point, 6> point;     ///< corners, then middles of the edges opposite to them
  std::array<double, 3> squares;  ///< squared lengths of the edges opposite to the corners, m^2

  /// Real-time: yes.
  void at(const std::array<double, 3>& lambda, Jet& out) const noexcept PALPATE_NONBLOCKING {
    std::size_t corner = 3;
    for (std::size_t k = 0; k < 3; ++k)
      if (lambda[k] > 0.5) corner = k;
    if (corner == 3) {  // between the middles
      const Sub sub{{3, 4, 5}, {0, 1, 2}, {Along{0.0, 0.5, 0.5}, Along{0.5, 0.0, 0.5}, Along{0.5, 0.5, 0.0}}};
      evaluate(sub, {1.0 - 2.0 * lambda[0], 1.0 - 2.0 * lambda[1], 1.0 - 2.0 * lambda[2]}, -2.0, out);
      return;
    }
    const std::size_t b = (corner + 1) % 3, c = (corner + 2) % 3;
    Sub sub{{corner, 3 + c, 3 + b}, {corner, b, c}, {}};
    sub.place[0][corner] = 1.0;
    sub.place[1][corner] = sub.place[1][b] = 0.5;
    sub.place[2][corner] = sub.place[2][c] = 0.5;
    evaluate(sub, {2.0 * lambda[corner] - 1.0, 2.0 * lambda[b], 2.0 * lambda[c]}, 2.0, out);
  }

 private:
  using Along = std::array<double, 3>;
  /// One of the four triangles: its points, the corners that they stand for, and where they are.
  struct Sub {
    std::array<std::size_t, 3> point, corner;
    std::array<Along, 3> place;
  };

  /// Along a way, by the quadratic through all six gradients.
  [[nodiscard]] Value derivative(const Along& lambda, const Along& way) const noexcept PALPATE_NONBLOCKING {
    Value sum = Value::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      const double corner = lambda[k] * (2.0 * lambda[k] - 1.0);
      const double middle = 4.0 * lambda[(k + 1) % 3] * lambda[(k + 2) % 3];
      for (std::size_t e = 1; e < 3; ++e)
        sum += (way[e] * corner) * point[k][e] + (way[e] * middle) * point[3 + k][e];
    }
    return sum;
  }

  /// @param mu  weights within the sub-triangle  @param rate  dmu/dlambda
  void evaluate(const Sub& sub, const std::array<double, 3>& mu, double rate,
                Jet& out) const noexcept PALPATE_NONBLOCKING {
    std::array<Value, 3> v, t, middle, inner;
    std::array<std::array<Value, 3>, 3> edge;  // [i][j] a third of the way from i to j
    for (std::size_t i = 0; i < 3; ++i) {
      const Point& at = point[sub.point[i]];
      v[i] = at[0];
      t[i] = v[i];
      for (std::size_t j = 0; j < 3; ++j) {
        if (j == i) continue;
        edge[i][j] = v[i] + ((sub.place[j][1] - sub.place[i][1]) / 3.0) * at[1] +
                     ((sub.place[j][2] - sub.place[i][2]) / 3.0) * at[2];
        t[i] += edge[i][j];
      }
      t[i] /= 3.0;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
      // Where the centre's foot on the edge from i to j is, 0 to 1.
      const double base = squares[sub.corner[k]];
      const double to_k = squares[sub.corner[j]], from_k = squares[sub.corner[i]];  // |ik|^2, |jk|^2
      const double foot = 1.0 / 3.0 + (base + to_k - from_k) / (6.0 * base), rest = 1.0 - foot;
      // Cubics of the two inner triangles at an edge: derivatives towards the centre at its ends, over 3, and in its middle.
      const Value at_i = t[i] - rest * v[i] - foot * edge[i][j],
                  at_j = t[j] - rest * edge[j][i] - foot * v[j];
      Along towards, between;
      for (std::size_t e = 0; e < 3; ++e) {
        const double centre = (sub.place[0][e] + sub.place[1][e] + sub.place[2][e]) / 3.0;
        towards[e] = centre - rest * sub.place[i][e] - foot * sub.place[j][e];
        between[e] = 0.5 * (sub.place[i][e] + sub.place[j][e]);
      }
      middle[k] = rest * edge[i][j] + foot * edge[j][i] - 0.5 * (at_i + at_j) +
                  (2.0 / 3.0) * derivative(between, towards);
    }
    for (std::size_t i = 0; i < 3; ++i) inner[i] = (t[i] + middle[(i + 1) % 3] + middle[(i + 2) % 3]) / 3.0;
    const Value centre = (inner[0] + inner[1] + inner[2]) / 3.0;
    std::size_t k = 0;
    if (mu[1] < mu[k]) k = 1;
    if (mu[2] < mu[k]) k = 2;
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    const double a = mu[i] - mu[k], b = mu[j] - mu[k], c = 3.0 * mu[k];
    // The quadratics whose mixture the cubic is: its derivatives by a, b and c, over 3.
    const Value by_a = a * a * v[i] + b * b * edge[j][i] + c * c * inner[i] +
                       2.0 * (a * b * edge[i][j] + a * c * t[i] + b * c * middle[k]);
    const Value by_b = a * a * edge[i][j] + b * b * v[j] + c * c * inner[j] +
                       2.0 * (a * b * edge[j][i] + a * c * middle[k] + b * c * t[j]);
    const Value by_c = a * a * t[i] + b * b * t[j] + c * c * centre +
                       2.0 * (a * b * middle[k] + a * c * inner[i] + b * c * inner[j]);
    out.value = a * by_a + b * by_b + c * by_c;
    out.slope[sub.corner[i]] = (3.0 * rate) * by_a;
    out.slope[sub.corner[j]] = (3.0 * rate) * by_b;
    out.slope[sub.corner[k]] = (3.0 * rate) * (3.0 * by_c - by_a - by_b);
  }
};

}  // namespace palpate
