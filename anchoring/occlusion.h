#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "anchoring/belief.h"
#include "anchoring/map_frame.h"

namespace anchord {

/// How objects hide each other from a sensor in one frame (thesis (2.11): what is hidden is not
/// visible, so not missed). Computed once per frame from the belief before it; empty where no class
/// has an extent, or the frame has no pose and so sees from nowhere.
///
/// Objects of the best world hide what lies behind them: in 2-D a disc, in 3-D an upright cylinder,
/// of the larger of length and width, or the box itself where its yaw was reported, at the centre
/// of the most probable tracked model's density. Across and along the line of sight to it, errors
/// of position count as independent.
class Occlusion {
 public:
  Occlusion() = default;
  Occlusion(const Belief& belief, const MapFrame& frame, const Background& background);

  bool none() const { return bodies_.empty(); }

  /// The probability that nothing hides the centre of an object with this density; `birth` is its
  /// anchor, which does not hide itself. Hiding objects count as independent of each other. Costs
  /// what stands before it, not what there is.
  double clear(const Gaussian& density, std::uint64_t birth) const;

 private:
  static constexpr int kBins = 512;  ///< of bearing

  struct Body {
    std::uint64_t birth = 0;
    double p = 0;                         ///< that it exists and is there
    double distance = 0;                  ///< of its centre from the eye, m
    double depth = 0;                     ///< from its centre to its far side, m
    bool round = false;                   ///< seen from above
    double nearest = 0;                   ///< where at the least it may be, m from the eye
    std::array<Eigen::Vector3d, 3> axis;  ///< from the eye to it; across, level; across, upward
    std::array<double, 3> low{}, high{};  ///< outline along the axes across, in the centre's plane
    std::array<double, 3> variance{};     ///< of its centre along the axes
    int first_bin = 0, bins = 0;
    bool in(int bin) const { return (bin - first_bin + kBins) % kBins < bins; }
  };
  struct Span {
    int first, count;
  };
  static Span span(const Eigen::Vector3d& from_eye, double radius);
  void add(const Leaf& leaf, std::uint64_t birth, double p, const Background& background);
  void sort_into_bins();
  double hides(const Body& body, const Eigen::Vector3d& from_eye,
               const Eigen::Matrix3d& covariance) const;

  Eigen::Vector3d eye_ = Eigen::Vector3d::Zero();
  int dims_ = 3;
  std::vector<Body> bodies_;  ///< nearest first
  std::vector<int> begins_;   ///< per bin where in in_bin_ its bodies begin
  std::vector<int> in_bin_;   ///< bodies by bin, nearest first
};

}  // namespace anchord
