#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "experiments/anchoring/hidden.h"
#include "experiments/anchoring/watching.h"
#include "knowledge/configuration.h"

namespace anchord::experiment {
namespace {

// Two like cups side by side, in sight, that nothing tells apart: the odds of the two ways round
// are what they were at first, however long that lasts.
TEST(Identity, OddsStayAsTheyAreWhileNothingTells) {
  // With a way back to standing still, which makes the most versions.
  const Knowledge carried =
      parse_configuration(R"({"include": "hidden-still.json", "classes": {"default": {
        "models": [{"kind": "constant_position", "position_psd": 1e-6},
                   {"kind": "constant_velocity", "acceleration_psd": 0.1,
                    "initial_velocity_variance": 0.09},
                   {"kind": "somewhere", "place": "table", "rate": 0.01}],
        "transitions": [{"from": 0, "to": 1, "rate": 0.01}, {"from": 1, "to": 0, "rate": 1}]}}})",
                          std::string(ANCHORD_SOURCE_DIR) + "/experiments/anchoring")
          .knowledge();
  for (const std::uint64_t seed : {1, 2, 3, 4, 6}) {  // in 5 the places tell: odds of 400
    Dice dice(seed);
    const HiddenFootage footage = simulate_hidden({Ambiguity::kSideBySide, 60, 0}, dice);
    World world(carried);
    std::vector<Standing> one, other;
    double first = 0, last = 0;
    for (std::size_t k = 0; k < footage.settled; ++k) {
      take(world, footage.frames[k]);
      if (k + 1 == footage.known)
        for (std::size_t i = 0; i < 2; ++i) {
          const auto shown = best_world(*world.belief());
          const Shown* cup = nearest(shown, footage.from[i], 0.1);
          ASSERT_TRUE(cup);
          one.push_back({cup->birth, footage.to[i]});
          other.push_back({cup->birth, footage.to[1 - i]});
        }
      if (k == 300 || k + 1 == footage.settled)
        (k == 300 ? first : last) = std::log(probability_of(*world.belief(), one, footage.near) /
                                             probability_of(*world.belief(), other, footage.near));
    }
    EXPECT_NEAR(last, first, 0.3) << "seed " << seed;  // ln odds; 1000 frames
  }
}

}  // namespace
}  // namespace anchord::experiment
