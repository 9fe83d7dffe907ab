#include "tools/anchor_tune/matching.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <map>
#include <memory>

#include "anchoring/visibility.h"
#include "mht/assignment.h"

namespace anchord::tuning {
namespace {

/// One recording's frames, judged in order of time.
class Judge {
 public:
  Judge(const Truth& truth, double radius, const Background& background)
      : truth_(truth),
        radius_(radius),
        background_(background),
        seen_(static_cast<std::size_t>(background.grid.size()), 0.0) {
    for (const auto& [utime, rows] : truth)
      for (const TruthRow& row : rows) rows_of_[row.id][utime] = &row;
  }

  /// Nothing for a frame without truth.
  Result<std::optional<JudgedFrame>> judge(const Frame& frame) {
    auto placed = place_in_map(frame, background_);
    if (!placed) return placed.error();
    if (!visibility_ || !visibility_->same_for(*placed))
      visibility_ = std::make_unique<Visibility>(*placed, background_);
    const auto rows = truth_.find(frame.utime);
    JudgedFrame out;
    out.utime = frame.utime;
    out.view = placed->view;
    if (rows != truth_.end()) {
      find_sights(*placed, rows->second, out);
      for (std::size_t z = 0; z < placed->detections.size(); ++z)
        out.detections.push_back(unjudged(placed->detections[z], frame, z));
      match(frame, rows->second, out);
      add_gaps(*placed, out);
    }
    look(frame.utime, out);
    if (rows == truth_.end()) return std::optional<JudgedFrame>();
    return std::optional(std::move(out));
  }

 private:
  /// A vector of the map along the sensor's axes.
  static Eigen::Vector3d turned(const Pose& pose, const Eigen::Vector3d& v) {
    const auto& q = pose.orientation;
    return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().conjugate() * v;
  }

  Judged unjudged(MapDetection placed, const Frame& frame, std::size_t i) const {
    const Detection& reported = frame.detections[i];
    Judged z;
    z.in_sensor = placed.position.mean;
    if (frame.pose) {
      const auto& p = frame.pose->position;
      z.in_sensor -= Eigen::Vector3d(p[0], p[1], background_.dims == 2 ? 0 : p[2]);
      z.in_sensor = turned(*frame.pose, z.in_sensor);
    }
    z.placed = std::move(placed);
    for (int c = 0; c < background_.classes(); ++c)  // what looks like none is told by its chain
      if (background_.object_class(c).phantom)
        z.placed.class_ratio[static_cast<std::size_t>(c)] = 0;
    z.seen_before = seen_before(z.placed.position.mean);
    z.score = reported.score;
    const auto* cartesian = std::get_if<CartesianMeasurement>(&reported.measurement);
    z.needs_noise = cartesian && cartesian->covariance.empty();
    return z;
  }

  bool seen_before(const Eigen::Vector3d& position) const {
    const int cell = background_.cell_of(position);
    return cell >= 0 && seen_[static_cast<std::size_t>(cell)] > 0.5;
  }

  double range(const MapFrame& frame, const Eigen::Vector3d& position) const {
    return frame.eye ? (position - *frame.eye).norm() : 0;  // in the plane z is 0
  }

  int class_of(const TruthRow& row) const {
    if (background_.classes() == 1 && row.class_name.empty()) return 0;
    return background_.knowledge.find_class(row.class_name);
  }

  /// Truth that may be found, into out.sights; scored_[row] says which, -1 if it is neutral.
  void find_sights(const MapFrame& frame, const std::vector<TruthRow>& rows, JudgedFrame& out) {
    scored_.assign(rows.size(), -1);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const int object_class = class_of(rows[i]);
      if (rows[i].neutral || object_class < 0 || !frame.view.contains(rows[i].position)) continue;
      scored_[i] = static_cast<int>(out.sights.size());
      out.sights.push_back({rows[i].id, object_class, rows[i].position, false,
                            seen_before(rows[i].position), range(frame, rows[i].position)});
    }
  }

  /// Objects that are between two of their rows, neither of them neutral.
  void add_gaps(const MapFrame& frame, JudgedFrame& out) const {
    const Utime utime = frame.utime;
    for (const auto& [id, rows] : rows_of_) {
      const auto after = rows.lower_bound(utime);
      if (after == rows.end() || after->first == utime || after == rows.begin()) continue;
      const auto before = std::prev(after);
      const int object_class = class_of(*before->second);
      if (before->second->neutral || after->second->neutral || object_class < 0) continue;
      const double share =
          seconds_between(before->first, utime) / seconds_between(before->first, after->first);
      const Eigen::Vector3d position =
          before->second->position + share * (after->second->position - before->second->position);
      if (frame.view.contains(position))
        out.sights.push_back({id, object_class, position, false, true, range(frame, position)});
    }
  }

  double cost(const MapDetection& z, const TruthRow& row) const {
    const double distance = (z.position.mean - row.position).head(background_.dims).norm();
    if (distance > radius_) return std::numeric_limits<double>::infinity();
    const bool other = z.has_class && label(z) != class_of(row);
    return distance + (other ? radius_ / 2 : 0);
  }

  void match(const Frame& frame, const std::vector<TruthRow>& rows, JudgedFrame& out) const {
    const Scratch scratch;
    const int m = static_cast<int>(rows.size());
    PairGains gains(static_cast<int>(out.detections.size()), m);
    for (const Judged& z : out.detections) {
      gains.start_row();
      for (int i = 0; i < m; ++i) {
        const double distance = cost(z.placed, rows[static_cast<std::size_t>(i)]);
        if (distance <= 1.5 * radius_) gains.add(i, 1.5 * radius_ - distance);
      }
    }
    const Assignment assignment(gains);
    for (int z = 0; z < assignment.detections(); ++z) {
      Judged& judged = out.detections[static_cast<std::size_t>(z)];
      const bool given = assignment.choice(z) != Assignment::kNone;
      const auto row = static_cast<std::size_t>(assignment.choice(z));
      if (given && scored_[row] >= 0) {
        Sight& sight = out.sights[static_cast<std::size_t>(scored_[row])];
        sight.found = true;
        judged.verdict = Verdict::kRight;
        judged.object = sight.object;
        judged.object_class = sight.object_class;
        judged.residual = judged.placed.position.mean - sight.position;
        if (background_.dims == 2) judged.residual.z() = 0;
        judged.sensor_residual = judged.residual;
        if (frame.pose) judged.sensor_residual = turned(*frame.pose, judged.residual);
        continue;
      }
      bool neutral = given;
      for (const PairGains::Entry& near : gains.of(z))
        neutral = neutral || scored_[static_cast<std::size_t>(near.leaf)] < 0;
      judged.verdict = neutral ? Verdict::kNeutral : Verdict::kFalse;
    }
  }

  /// Takes what is in view as seen, and says how much of it was new.
  void look(Utime utime, JudgedFrame& out) {
    double fresh = 0;
    const Tiling& tiling = *background_.tiling;
    for (const Look::Tile& tile : visibility_->look().tiles) {
      const int x0 = tile.tile % tiling.columns * Tiling::kEdge;
      const int y0 = tile.tile / tiling.columns * Tiling::kEdge;
      for (int y = 0; y < Tiling::kEdge && y0 + y < tiling.grid.rows; ++y)
        for (int x = 0; x < Tiling::kEdge && x0 + x < tiling.grid.columns; ++x) {
          double& before = seen_[static_cast<std::size_t>((y0 + y) * tiling.grid.columns + x0 + x)];
          const double share = tile.share[static_cast<std::size_t>(y * Tiling::kEdge + x)];
          fresh += std::max(0.0, share - before);
          before = std::max(before, share);
        }
    }
    out.volume = visibility_->volume();
    out.new_volume = fresh * background_.cell_volume();
    if (last_) out.old_seconds = (out.volume - out.new_volume) * seconds_between(*last_, utime);
    last_ = utime;
  }

  const Truth& truth_;
  double radius_;
  const Background& background_;
  std::map<std::string, std::map<Utime, const TruthRow*>> rows_of_;  // per object
  std::vector<double> seen_;  // per cell, the greatest share that was in view at once
  std::vector<int> scored_;
  std::unique_ptr<Visibility> visibility_;
  std::optional<Utime> last_;
};

}  // namespace

int label(const MapDetection& z) {
  if (!z.has_class) return -1;
  const auto top = std::max_element(z.class_ratio.begin(), z.class_ratio.end());
  return static_cast<int>(top - z.class_ratio.begin());
}

Result<Judgement> judge(const std::vector<Recording>& recordings, double radius,
                        const Background& background) {
  Judgement out;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    Judge one(*recordings[r].truth, radius, background);
    for (const Frame& frame : recordings[r].frames) {
      auto judged = one.judge(frame);
      if (!judged) return judged.error();
      if (!*judged) continue;
      (*judged)->recording = static_cast<int>(r);
      const auto name = std::find(out.sensors.begin(), out.sensors.end(), frame.sensor);
      (*judged)->sensor = static_cast<int>(name - out.sensors.begin());
      if (name == out.sensors.end()) out.sensors.push_back(frame.sensor);
      out.frames.push_back(std::move(**judged));
    }
  }
  return out;
}

}  // namespace anchord::tuning
