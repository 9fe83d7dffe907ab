#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace anchord {

/// The integral of f over [from, to] by the Gauss-Kronrod rule with 10 and 21 nodes, halved until
/// the two differ by less than `tolerance` on every part (the 21-node value is far closer than
/// that), at most `depth` times. Nodes and weights: Piessens et al., QUADPACK (1983), rule QK21.
template <typename Function>
double integrate(const Function& f, double from, double to, double tolerance, int depth) {
  static constexpr std::array<double, 10> kNode = {
      0.995657163025808080735527280689003, 0.973906528517171720077964012084452,
      0.930157491355708226001207180059508, 0.865063366688984510732096688423493,
      0.780817726586416897063717578345042, 0.679409568299024406234327365114874,
      0.562757134668604683339000099272694, 0.433395394129247190799265943165784,
      0.294392862701460198131126603103866, 0.148874338981631210884826001129720};
  static constexpr std::array<double, 11> kKronrod = {
      0.011694638867371874278064396062192, 0.032558162307964727478818972459390,
      0.054755896574351996031381300244580, 0.075039674810919952767043140916190,
      0.093125454583697605535065465083366, 0.109387158802297641899210590325805,
      0.123491976262065851077958109585166, 0.134709217311473325928054001771707,
      0.142775938577060080797094273138717, 0.147739104901338491374841515972068,
      0.149445554002916905664936468389821};
  static constexpr std::array<double, 5> kGauss = {
      0.066671344308688137593568809893332, 0.149451349150580593145863396957658,
      0.219086362515982043995534934228163, 0.269266719309996355091226921569469,
      0.295524224714752870173815619188769};
  const double middle = (from + to) / 2, half = (to - from) / 2;
  double kronrod = kKronrod[10] * f(middle), gauss = 0;
  for (int i = 0; i < 10; ++i) {
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
