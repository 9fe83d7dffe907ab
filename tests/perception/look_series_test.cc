#include "perception/look_series.h"

#include <gtest/gtest.h>

namespace anchord {
namespace {

using Sight = Sighting::Sight;

TEST(LookSeries, MissingTakesLooksInARow) {
  using Outcome = VerificationResult::Outcome;
  const auto saw = [](Sight sight) {
    Sighting sighting;
    sighting.sight = sight;
    return sighting;
  };
  LookSeries series(3);
  EXPECT_FALSE(series.add(saw(Sight::kAbsent)));
  EXPECT_FALSE(series.add(saw(Sight::kAbsent)));
  EXPECT_FALSE(series.add(saw(Sight::kDoubtful)));  // breaks the row
  EXPECT_FALSE(series.add(saw(Sight::kAbsent)));
  EXPECT_FALSE(series.add(saw(Sight::kAbsent)));
  EXPECT_EQ(series.add(saw(Sight::kAbsent)), Outcome::kMissing);
  LookSeries hidden(2);
  EXPECT_FALSE(hidden.add(saw(Sight::kAbsent)));
  EXPECT_FALSE(hidden.add(saw(Sight::kHidden)));
  EXPECT_FALSE(hidden.add(saw(Sight::kElsewhere)));  // breaks it, too
  EXPECT_FALSE(hidden.add(saw(Sight::kHidden)));
  EXPECT_EQ(hidden.add(saw(Sight::kHidden)), Outcome::kOccluded);
  EXPECT_EQ(LookSeries(3).add(saw(Sight::kFound)), Outcome::kFound);
}

}  // namespace
}  // namespace anchord
