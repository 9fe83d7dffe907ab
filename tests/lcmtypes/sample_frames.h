#pragma once

#include "core/frame.h"

namespace anchord::testing {

/// A frame that uses every field but the other views'.
inline Frame full_frame() {
  Frame frame;
  frame.utime = 1'700'000'000'000'000;
  frame.robot = "amigo";
  frame.sensor = "kinect";
  frame.pose.emplace();
  frame.pose->position = {0.5, -1.25, 1.2};
  frame.pose->orientation = {0.5, 0.5, -0.5, 0.5};
  for (int i = 0; i < 36; i += 7) frame.pose->covariance[i] = 1e-4 * (i + 1);
  frame.view.emplace();
  frame.view->type = View::Type::kSector;
  frame.view->range = {0.3, 5};
  frame.view->bearing = {-0.5, 0.5};
  frame.view->elevation = {-0.25, 0.25};
  Detection cup;
  cup.measurement = CartesianMeasurement{{1, 0.2, 0.9}, {1e-3, 0, 0, 0, 1e-3, 0, 0, 0, 2e-3}};
  cup.score = 0.9;
  cup.yaw = -0.75;
  cup.object = "cup-1";
  cup.attributes = {{"class", SymbolReport{{{"cup", 0.8}, {"tea_box", 0.1}}}},
                    {"size", ScalarReport{0.12, 4e-4}}};
  Detection seen_by_laser;
  seen_by_laser.measurement = PolarMeasurement{2.5, 0.1, 0, {1e-4, 1e-5, 1e-5}};
  Detection flat;
  flat.measurement = CartesianMeasurement{{1, 2}, {1e-3, 0, 0, 1e-3}};
  frame.detections = {cup, seen_by_laser, flat};
  return frame;
}

}  // namespace anchord::testing
