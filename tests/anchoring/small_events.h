#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/event.h"
#include "tests/anchoring/small_world.h"

namespace anchord {

/// Something that happens to an object at `seconds`, as at_second() counts them.
Event event(Event::Kind kind, double seconds, const std::string& object = "");
Event in_place(Event event, const std::string& place);
Event at_position(Event event, double x, double y);
/// A robot that holds things, there.
Event carried(double seconds, double x, double y, const std::string& robot = "");
Event named(double seconds, const std::string& object, const std::string& alias);
Event joined(double seconds, const std::string& object, const std::string& other);
Event undone(double seconds, std::int64_t number);

/// A box between two corners, any height.
RegionOfInterest box_of_interest(double x_min, double y_min, double x_max, double y_max);
/// Looked for there by the sensor `eye`, and not found.
Event missing(double seconds, const std::string& object, const RegionOfInterest& region);

/// Applies an event that must be accepted; its number.
std::int64_t apply(World& world, const Event& event);

/// The object that is called so; it must be there.
ObjectBelief find(const World& world, const std::string& called);
/// The only leaf of the anchor that is called so.
const Leaf& leaf_of(const World& world, const std::string& called);

/// What is believed of every anchor, as text; without the hypotheses, whose order may differ.
std::string every_object(const World& world);

}  // namespace anchord
