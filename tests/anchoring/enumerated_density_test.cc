#include "tests/anchoring/enumerated_density.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace anchord::enumeration {
namespace {

constexpr double kRounding = 1e-12;  // of short closed forms, and of the quadrature

TEST(EnumeratedDensity, QuadrantOfACorrelatedNormal) {
  for (const double rho : {-0.999, -0.5, 0.001, 0.9}) {
    Eigen::Matrix2d covariance;
    covariance << 4, 2 * rho * 0.5, 2 * rho * 0.5, 0.25;  // deviations 2 and 0.5
    // P(x > 0, y > 0) = 1/4 + asin(rho) / (2 pi) (Sheppard); 40 deviations stand for infinity.
    EXPECT_NEAR(probability({1, 2}, covariance, {1, 2, 81, 22}),
                0.25 + std::asin(rho) / (2 * std::numbers::pi), kRounding);
  }
}

TEST(EnumeratedDensity, AnLIsCutIntoRectangles) {
  double area = 0;
  for (const Rectangle& r : rectangles({{0, 0}, {0, 3}, {1, 3}, {1, 1}, {4, 1}, {4, 0}}))
    area += (r[2] - r[0]) * (r[3] - r[1]);
  EXPECT_NEAR(area, 6, kRounding);
}

TEST(EnumeratedDensity, ExponentialOfARotation) {
  Eigen::Matrix2d a;
  a << 0, -5, 5, 0;
  EXPECT_NEAR(exponential(a)(1, 0), std::sin(5.0), kRounding);
}

}  // namespace
}  // namespace anchord::enumeration
