#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace anchord {

/// The integral of f over [from, to] by the Gauss-Kronrod rule with 7 and 15 nodes, halved until
/// the two differ by less than `tolerance` on every part (the 15-node value is far closer than
/// that), at most `depth` times. Nodes and weights: Piessens et al., QUADPACK (1983), rule QK15.
template <typename Function>
double integrate(const Function& f, double from, double to, double tolerance, int depth) {
  static constexpr std::array<double, 7> kNode = {
      0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
      0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
      0.586087235467691130294144691693258, 0.405845151377397166906606412076961,
      0.207784955007898467600689403773245};
  static constexpr std::array<double, 8> kKronrod = {
      0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
      0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
      0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
      0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
  static constexpr std::array<double, 4> kGauss = {
      0.129484966168869693270611432679082, 0.279705391489276667901467771423780,
      0.381830050505118944950369775488975, 0.417959183673469387755102040816327};
  const double middle = (from + to) / 2, half = (to - from) / 2;
  const double at_middle = f(middle);
  double kronrod = kKronrod[7] * at_middle, gauss = kGauss[3] * at_middle;
  for (int i = 0; i < 7; ++i) {
    const double pair = f(middle - half * kNode[i]) + f(middle + half * kNode[i]);
    kronrod += kKronrod[i] * pair;
    if (i % 2 == 1) gauss += kGauss[i / 2] * pair;
  }
  if (depth == 0 || !(std::abs(kronrod - gauss) * half > tolerance)) return kronrod * half;
  return integrate(f, from, middle, tolerance, depth - 1) +
         integrate(f, middle, to, tolerance, depth - 1);
}

/// The sum of f at `count` points, `step` apart from `first` on.
template <typename Function>
double sum_at(const Function& f, double first, double step, int count) {
  double sum = 0;
  for (int i = 0; i < count; ++i) sum += f(first + step * i);
  return sum;
}

/// The integral of f over those parts of the angles [from, to] that lie within `reach` of `peak`
/// modulo 2 pi (`reach` = pi: everything). `from` in [-pi, pi], at most 2 pi before `to`. If the
/// peak is not cut, f must be as good as zero `reach` away from it.
template <typename Function>
double integrate_around(const Function& f, double from, double to, double peak, double reach,
                        double tolerance, int depth) {
  double sum = 0;
  for (int turn = -1; turn <= 2; ++turn) {
    const double centre = peak + 2 * std::numbers::pi * turn;
    const double low = std::max(from, centre - reach), high = std::min(to, centre + reach);
    if (low >= high) continue;
    const bool whole = low == centre - reach && high == centre + reach;
    if (whole && reach < std::numbers::pi / 2) {
      // A whole bell: the trapezoidal rule converges faster than any power of its step.
      constexpr int kSteps = 12;
      const double step = 2 * reach / kSteps;
      const double coarse = step * sum_at(f, low + step, step, kSteps - 1);
      const double fine = (coarse + step * sum_at(f, low + step / 2, step, kSteps)) / 2;
      if (std::abs(fine - coarse) < 10 * tolerance) {
        sum += fine;
        continue;
      }
    }
    // Over a short part of a wide bell the peak is not worth a cut.
    const bool smooth = reach == std::numbers::pi && high - low < std::numbers::pi / 2;
    const double cut = smooth ? low : std::clamp(centre, low, high);
    if (low < cut) sum += integrate(f, low, cut, tolerance, depth);
    if (cut < high) sum += integrate(f, cut, high, tolerance, depth);
  }
  return sum;
}

}  // namespace anchord
