#include "maintenance/viewpoint.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace anchord {
namespace {

constexpr double kDegree = 3.141592653589793 / 180;
// How far round the object from the robot's side, the nearest first.
constexpr double kAround[] = {0, 30, -30, 60, -60, 90, -90, 125, -125, 180};
constexpr double kInside = 0.1;         // share of its ranges that a sensor keeps off their ends
constexpr std::size_t kMostSeeds = 16;  // subjects around which shared viewpoints are sought
constexpr std::size_t kMostLooks = 2000;
constexpr double kLeastShare = 1e-3;  // nat that a further shared viewpoint must add

/// The yaw of a base from whose sensor a point lies in the middle of what it sees.
double facing(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Eye& eye) {
  const Eigen::Vector2d d = to - from;
  return std::remainder(std::atan2(d.y(), d.x()) - eye.yaw - eye.bearing, 2 * 3.141592653589793);
}

/// Whether a point is in view, and not at the very end of the sensor's ranges.
bool well_in_view(const Eigen::Vector3d& point, const Eye& eye, const BasePose& base,
                  const Site& site) {
  if (!site.sees(eye, base, point)) return false;
  const auto [low, high] = std::minmax_element(eye.ranges.begin(), eye.ranges.end());
  if (*high <= 0) return true;
  const double range = (point - site.stance(eye, base).sensor).norm();
  const double margin = kInside * (*high - *low);
  return range >= *low + margin && range <= *high - margin;
}

bool in_bounds(const Eigen::Vector2d& position, const Site& site) {
  return (position.array() >= site.bounds_min.head<2>().array()).all() &&
         (position.array() <= site.bounds_max.head<2>().array()).all();
}

/// The base at a range and bearing from a point, towards it; none if it does not see the point.
std::optional<BasePose> stand(const Eigen::Vector3d& point, double range, double bearing,
                              const Eye& eye, double z, const Site& site) {
  const double height = site.dims == 3 ? point.z() - z - eye.mount.z() : 0;
  const double flat2 = range * range - height * height;
  if (flat2 < 0) return std::nullopt;
  const Eigen::Vector2d out(std::cos(bearing), std::sin(bearing));
  BasePose base;
  base.z = z;
  const Eigen::Vector2d sensor = point.head<2>() + std::sqrt(flat2) * out;
  base.yaw = facing(sensor, point.head<2>(), eye);
  const double c = std::cos(base.yaw), s = std::sin(base.yaw);
  base.position = sensor - Eigen::Vector2d(c * eye.mount.x() - s * eye.mount.y(),
                                           s * eye.mount.x() + c * eye.mount.y());
  if (!in_bounds(base.position, site) || !site.sees(eye, base, point)) return std::nullopt;
  return base;
}

/// What each subject would gain if an eye had one look at it now, best first; only those above 0.
struct Chance {
  double gain;
  int subject;
};
std::vector<Chance> chances(const std::vector<Viewpoint>& single, int eye, Forecast& forecast) {
  std::vector<Chance> all;
  for (const Viewpoint& viewpoint : single) {
    if (viewpoint.eye != eye) continue;
    forecast.look({eye, viewpoint.base, 0});
    const double gain = forecast.gain_of(viewpoint.subject, 0);
    forecast.reset();
    if (gain > 0) all.push_back({gain, viewpoint.subject});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Chance& a, const Chance& b) { return a.gain > b.gain; });
  return all;
}

/// The targets, in order; of more than `most` those of the greatest entropy.
std::vector<std::size_t> vaguest(const std::vector<Subject>& subjects, int most, const Site& site) {
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < subjects.size(); ++i)
    if (subjects[i].target) all.push_back(i);
  if (all.size() <= static_cast<std::size_t>(most)) return all;
  const Forecast forecast(subjects, site);
  std::vector<double> entropy;
  for (std::size_t i = 0; i < subjects.size(); ++i)
    entropy.push_back(forecast.entropies(static_cast<int>(i), 0).without);
  std::stable_sort(all.begin(), all.end(),
                   [&](std::size_t a, std::size_t b) { return entropy[a] > entropy[b]; });
  all.resize(static_cast<std::size_t>(most));
  std::sort(all.begin(), all.end());
  return all;
}

/// Adds up to `most` viewpoints that see several subjects.
void add_shared(const std::vector<Subject>& subjects, int eye_index, const BasePose& from, int most,
                const Site& site, std::vector<Viewpoint>& out) {
  const Eye& eye = site.eyes[static_cast<std::size_t>(eye_index)];
  Forecast forecast(subjects, site);
  const std::vector<Chance> all = chances(out, eye_index, forecast);
  std::vector<Eigen::Vector3d> means;
  for (const Chance& chance : all)
    means.push_back(subjects[static_cast<std::size_t>(chance.subject)].mean());
  struct Candidate {
    BasePose base;
    std::vector<int> seen;  // indices into `all`
  };
  std::vector<Candidate> candidates;
  for (std::size_t seed = 0; seed < std::min(all.size(), kMostSeeds); ++seed)
    for (const double degrees : {0.0, 45.0, 90.0, 135.0, 180.0, 225.0, 270.0, 315.0})
      for (const std::size_t range : {0u, 3u}) {
        const auto base =
            stand(means[seed], eye.ranges[range], degrees * kDegree, eye, from.z, site);
        if (!base) continue;
        Candidate candidate{*base, {}};
        const Stance stance = site.stance(eye, *base);
        for (std::size_t i = 0; i < all.size(); ++i)
          if (site.sees(eye, stance, means[i])) candidate.seen.push_back(static_cast<int>(i));
        if (candidate.seen.size() > 1) candidates.push_back(std::move(candidate));
      }
  std::vector<char> covered(all.size(), 0);
  for (int n = 0; n < most; ++n) {
    double best = kLeastShare, nearest = 0;
    const Candidate* chosen = nullptr;
    for (const Candidate& candidate : candidates) {
      double sum = 0;
      for (const int i : candidate.seen)
        if (!covered[static_cast<std::size_t>(i)]) sum += all[static_cast<std::size_t>(i)].gain;
      const double away = (candidate.base.position - from.position).norm();
      if (sum < best || (sum == best && chosen && away >= nearest)) continue;
      best = sum;
      nearest = away;
      chosen = &candidate;
    }
    if (!chosen) return;
    int subject = -1;
    for (const int i : chosen->seen) {
      if (subject < 0) subject = all[static_cast<std::size_t>(i)].subject;  // the greatest gain
      covered[static_cast<std::size_t>(i)] = 1;
    }
    out.push_back({subject, eye_index, chosen->base, true});
  }
}

}  // namespace

std::optional<BasePose> viewpoint_of(const Eigen::Vector3d& point, const Eye& eye,
                                     const BasePose& from, const Site& site) {
  if (!point.allFinite()) return std::nullopt;
  if (!eye.moves_base) return site.sees(eye, from, point) ? std::optional(from) : std::nullopt;
  BasePose turned = from;
  const Eigen::Vector2d side = from.position - point.head<2>();
  if (side.norm() > 1e-9) turned.yaw = facing(from.position, point.head<2>(), eye);
  // A sensor that is not over the base's middle sees the point a little aside.
  if (well_in_view(point, eye, turned, site)) return turned;
  const double bearing = side.norm() > 1e-9 ? std::atan2(side.y(), side.x()) : from.yaw;
  for (const double around : kAround)
    for (const double range : eye.ranges)
      if (const auto base = stand(point, range, bearing + around * kDegree, eye, from.z, site))
        return base;
  return std::nullopt;
}

std::vector<Viewpoint> viewpoints(const std::vector<Subject>& subjects, const BasePose& from,
                                  int shared, int targets, const Site& site) {
  std::vector<Viewpoint> out;
  for (const std::size_t i : vaguest(subjects, targets, site)) {
    for (std::size_t e = 0; e < site.eyes.size(); ++e) {
      const auto base = viewpoint_of(subjects[i].mean(), site.eyes[e], from, site);
      if (base) out.push_back({static_cast<int>(i), static_cast<int>(e), *base, false});
    }
  }
  for (std::size_t e = 0; e < site.eyes.size(); ++e)
    if (shared > 0 && site.eyes[e].moves_base)
      add_shared(subjects, static_cast<int>(e), from, shared, site, out);
  return out;
}

void follow(const Way& way, const Viewpoint& viewpoint, double start, const Site& site,
            Course& course) {
  const Eye& eye = site.eyes[static_cast<std::size_t>(viewpoint.eye)];
  const double speed = site.settings.speed;
  const double duration = way.length / speed + eye.dwell;
  const double step = std::max(site.settings.step, duration / static_cast<double>(kMostLooks));
  course.looks.clear();
  course.length = way.length;
  const double stride = step * speed;
  double along = stride;  // of the next look, from the beginning of this piece
  double done = 0;        // of the pieces before
  for (std::size_t i = 1; i < way.points.size(); ++i) {
    const Eigen::Vector2d d = way.points[i] - way.points[i - 1];
    const double length = d.norm();
    const double yaw = std::atan2(d.y(), d.x());
    for (; along < length; along += stride)
      course.looks.push_back({viewpoint.eye,
                              {way.points[i - 1] + along / length * d, yaw, viewpoint.base.z},
                              start + (done + along) / speed});
    along -= length;
    done += length;
  }
  const double arrival = start + way.length / speed;
  course.end = arrival + eye.dwell;
  course.looks.push_back({viewpoint.eye, viewpoint.base, arrival});
  if (eye.dwell <= 0) return;
  for (int k = 1; k * step < eye.dwell * (1 - 1e-9); ++k)
    course.looks.push_back({viewpoint.eye, viewpoint.base, arrival + k * step});
  course.looks.push_back({viewpoint.eye, viewpoint.base, course.end});
}

}  // namespace anchord
