#include "anchoring/visibility.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/anchoring/small_world.h"

namespace anchord {
namespace {

using enumeration::Dice;

/// Rooms as high as the world and a table that is not, with a wall between the rooms.
Knowledge rooms() {
  return small_world(R"({
    "world": {"dimensions": 3, "bounds": {"min": [0, 0, 0], "max": [6, 4, 2.5]}, "cell": 0.25,
              "walls": [[[3, 0], [3, 2.5]]]},
    "places": [{"name": "kitchen", "polygon": [[0, 0], [3, 0], [3, 4], [0, 4]]},
               {"name": "hall", "polygon": [[3.1, 0], [6, 0], [6, 4], [3.1, 4]]},
               {"name": "outside", "polygon": [[5, 3], [8, 3], [8, 6], [5, 6]]},
               {"name": "table", "parent": "kitchen", "z": [0.7, 1.1],
                "polygon": [[1, 1], [2, 1], [2, 2], [1, 2]]}],
    "sensors": {"default": {"noise": [0.01, 0, 0, 0, 0.01, 0, 0, 0, 0.01],
                            "view": {"type": "frustum", "hfov": 1, "vfov": 0.8, "range": [0.3, 4]}}}
  })");
}

/// What the view has of a box, times the share of points spread in it that no wall hides.
double in_view(const Eigen::Vector3d& low, const Eigen::Vector3d& high, const MapFrame& placed,
               const Background& background) {
  int clear = 0;
  for (int n = 0; n < 16; ++n) {
    const Eigen::Vector3d share((n % 2 + 0.5) / 2, (n / 2 % 2 + 0.5) / 2, (n / 4 + 0.5) / 4);
    const Eigen::Vector3d point = low + share.cwiseProduct(high - low);
    clear += !background.walls.hide(*placed.eye, point);
  }
  return placed.view.share(low, high) * clear / 16;
}

TEST(Visibility, OfAPlaceIsThatOfEachOfItsCellsWhicheverGridHasIt) {
  const Background background(rooms());
  std::mt19937_64 random(5);
  Dice dice(random);
  for (int look = 0; look < 30; ++look) {
    Frame from = frame(look, {});
    const double half = dice.uniform(-3.1, 3.1) / 2;
    from.pose = Pose{{dice.uniform(0, 6), dice.uniform(0, 4), dice.uniform(0.5, 2)},
                     {std::cos(half), 0, 0, std::sin(half)},
                     {}};
    const MapFrame placed = *place_in_map(from, background);
    const Visibility visibility(placed, background);
    for (int place = -1; place < 4; ++place) {
      const Footprint& footprint = *background.footprint(place);
      const auto& shares = visibility.of(footprint);
      for (std::size_t i = 0; i < shares.size(); ++i) {
        const Eigen::Vector3d low = footprint.grid.corner_min(footprint.cells[i]);
        const Eigen::Vector3d high = footprint.grid.corner_max(footprint.cells[i]);
        EXPECT_NEAR(shares[i], in_view(low, high, placed, background), 1e-9)
            << "place " << place << ", cell " << i;
      }
    }
  }
}

}  // namespace
}  // namespace anchord
