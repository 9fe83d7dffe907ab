#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace anchord::bench {

/// A believed object.
struct Track {
  std::uint64_t id = 0;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
};

/// Counts identity switches as CLEAR-MOT does (Bernardin, Stiefelhagen 2008): in each frame last
/// frame's pairs of object and track are kept while they lie within the radius; the others are
/// paired with as many as possible, then least distance. A switch is an object that is paired with
/// another track than the last time it was paired.
class IdentityCount {
 public:
  explicit IdentityCount(double radius_m) : radius_(radius_m) {}

  /// One frame: the true positions, by object (the same ones in every frame), and the tracks.
  void add(const std::vector<Eigen::Vector2d>& truth, const std::vector<Track>& tracks);

  /// Per object, the track that it was paired with in the last frame, or -1.
  const std::vector<std::int64_t>& paired() const { return paired_; }

  int switches = 0;
  long misses = 0;   ///< objects without a track
  long strays = 0;   ///< tracks without an object
  long objects = 0;  ///< summed over frames

 private:
  static constexpr std::int64_t kNone = -1;
  double radius_;
  std::vector<std::int64_t> paired_;  ///< per object its track in the last frame
  std::vector<std::int64_t> last_;    ///< per object the last track it was paired with
};

}  // namespace anchord::bench
