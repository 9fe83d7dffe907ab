#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "anchoring/reading.h"
#include "anchoring/world.h"
#include "core/frame.h"
#include "knowledge/knowledge.h"
#include "tests/anchoring/dice.h"

namespace anchord {

/// The knowledge that a configuration gives; aborts with its mistakes if it has any.
Knowledge knowledge_from(std::string_view configuration);

/// A 2-D apartment of 6 x 4 m: `kitchen` (x below 3) with the `table` [1, 2] x [1, 2], and `hall`.
/// Classes cup and box that stay where they are, p_D 0.9, undetected intensity 0.01 per m^2 each;
/// attributes color (red, green, blue) and size (small up to 0.15 m, large up to 0.5 m). Every
/// sensor sees everything, with a clutter density of 0.001. `more` is merged over it, key by key.
Knowledge small_world(std::string_view more = "{}");

/// Limits that leave the engine exact, for small_world().
inline constexpr std::string_view kExact =
    R"({"hypotheses": {"max": 0, "min_weight": 0, "gate_probability": 1, "scan_depth": 0,
                       "min_existence": 0}})";

/// 2023-11-14, as that many seconds after it.
Utime at_second(double seconds);

/// A detection with R = variance I.
Detection at(double x, double y, double variance = 1e-4);
/// The same, reported as that symbol of an attribute with probability p.
Detection at(double x, double y, const std::string& attribute, const std::string& symbol, double p);

Frame frame(double seconds, std::vector<Detection> detections, const std::string& sensor = "eye");

/// What is seen of like objects at rest, 0.2 m apart in rows of `row` that begin at (1, 1) and each
/// `apart` m further: nine in ten of them, with noise of that deviation (m), and with probability
/// `clutter` something anywhere.
std::vector<Detection> rows(enumeration::Dice& dice, int objects, int row, double apart,
                            double deviation, double clutter);

/// A frame that looks at nothing, from a sensor of its own: time passes.
Frame blink(double seconds);

/// Applies frames that must be accepted.
void apply(World& world, const std::vector<Frame>& frames);

/// All that there is to read in a world's belief, as text: equal beliefs give equal bytes.
std::string everything(const World& world);

/// Every anchor now as its own name has it, densities as the filters hold them.
std::vector<ObjectBelief> anchors_by_name(const World& world);

/// The objects of p > 0 now, in order of birth.
std::vector<ObjectBelief> objects(const World& world);
std::vector<std::string> ids(const World& world);

}  // namespace anchord
