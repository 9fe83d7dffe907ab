#pragma once

namespace anchord {

/// A number for each axis of the map: one for x and y, one for z. A plain number holds for all.
struct ByAxis {
  double plane = 0, height = 0;

  ByAxis() = default;
  ByAxis(double all) : plane(all), height(all) {}  // NOLINT: a plain number is one
  ByAxis(double in_plane, double in_height) : plane(in_plane), height(in_height) {}

  /// What z has of the others' number.
  double vertical() const { return plane > 0 ? height / plane : 1; }
  /// Another number for x and y, with the same share of it for z.
  ByAxis with_plane(double other) const { return {other, other * vertical()}; }
  bool operator==(const ByAxis&) const = default;
  double operator[](int axis) const { return axis < 2 ? plane : height; }
};

}  // namespace anchord
