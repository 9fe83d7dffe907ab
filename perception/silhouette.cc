#include "perception/silhouette.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace anchord {

namespace {

/// A walking person's outline at one height of the body, in units of the body's height.
struct Outline {
  double y;           ///< from the crown (0) to the soles (1)
  double peak;        ///< probability that the middle is covered
  double half_width;  ///< where that has fallen to half
};

// The mean of the foreground of 3,700 boxes of single people walking in all directions
// (PETS 2009 S2.L1, view 1).
constexpr std::array<Outline, 10> kOutline = {{{-0.02, 0.05, 0.040},
                                               {0.01, 0.35, 0.045},
                                               {0.06, 0.80, 0.062},
                                               {0.14, 0.85, 0.078},
                                               {0.22, 0.95, 0.125},
                                               {0.40, 0.95, 0.150},
                                               {0.58, 0.93, 0.120},
                                               {0.72, 0.80, 0.105},
                                               {0.95, 0.60, 0.130},
                                               {1.03, 0.08, 0.120}}};
constexpr double kEdge = 0.02;   ///< softness of the outline
constexpr double kReach = 0.25;  ///< half the width of the box

Outline outline_at(double y) {
  for (std::size_t i = 1; i < kOutline.size(); ++i) {
    const Outline& above = kOutline[i - 1];
    const Outline& below = kOutline[i];
    if (y > below.y) continue;
    const double share = (y - above.y) / (below.y - above.y);
    return {y, above.peak + share * (below.peak - above.peak),
            above.half_width + share * (below.half_width - above.half_width)};
  }
  return kOutline.back();
}

constexpr double kTop = kOutline.front().y;
constexpr double kBottom = kOutline.back().y;
constexpr int kRows = 128, kColumns = 32;  // cells finer than the pixels of people in pictures
using Table = std::array<std::array<float, kColumns>, kRows>;

/// The coverage by row from the crown and column from the body's axis.
Table make_table() {
  Table table;
  for (int row = 0; row < kRows; ++row) {
    const Outline outline = outline_at(kTop + (row + 0.5) * (kBottom - kTop) / kRows);
    for (int column = 0; column < kColumns; ++column) {
      const double x = (column + 0.5) * kReach / kColumns;
      table[row][column] =
          static_cast<float>(outline.peak / (1 + std::exp((x - outline.half_width) / kEdge)));
    }
  }
  return table;
}
const Table kTable = make_table();

}  // namespace

cv::Rect Silhouette::box() const {
  const double reach = kReach * height_px();
  const double left = std::min(foot.x(), head.x()) - reach;
  const double right = std::max(foot.x(), head.x()) + reach;
  const double top = head.y() + kTop * height_px();
  const double bottom = head.y() + kBottom * height_px();
  return {cv::Point(cvFloor(left), cvFloor(top)), cv::Point(cvCeil(right), cvCeil(bottom))};
}

double Silhouette::coverage(double u, double v) const {
  const double y = (v - head.y()) / height_px();
  const double x = std::abs(u - head.x() - y * (foot.x() - head.x())) / height_px();
  if (y < kTop || y >= kBottom || x >= kReach) return 0;
  const auto row = static_cast<std::size_t>((y - kTop) * (kRows / (kBottom - kTop)));
  const auto column = static_cast<std::size_t>(x * (kColumns / kReach));
  return kTable[std::min<std::size_t>(row, kRows - 1)][std::min<std::size_t>(column, kColumns - 1)];
}

std::optional<Silhouette> stand(const Camera& camera, const Eigen::Vector2d& foot,
                                double height_m) {
  const std::optional<GroundPoint> ground = camera.to_ground(foot);
  if (!ground) return std::nullopt;
  Silhouette result;
  result.foot = foot;
  result.head = camera.project({ground->position.x(), ground->position.y(), height_m});
  result.position = ground->position;
  result.height_m = height_m;
  if (!(result.height_px() > 1)) return std::nullopt;
  return result;
}

}  // namespace anchord
