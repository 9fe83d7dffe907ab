// The least that a detector has to do: publish what one sensor saw, here once a second.
//
// The sensor is the `kinect` of config/home.json, which knows the view and the noise already.

#include <anchord/frame_t.hpp>
#include <chrono>
#include <cstdio>
#include <lcm/lcm-cpp.hpp>
#include <thread>

namespace {

std::int64_t now_utime() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

anchord::attribute_t symbol(const char* name, const char* value, double p) {
  anchord::attribute_t attribute{};
  attribute.name = name;
  attribute.kind = anchord::attribute_t::SYMBOLS;
  attribute.symbols = {value};
  attribute.probabilities = {p};
  attribute.num_symbols = 1;
  return attribute;
}

/// Where the camera stands in the map: 1.2 m above (3, 1), looking along +y, placed to 1 cm.
anchord::pose_t camera_pose() {
  anchord::pose_t pose{};
  pose.position[0] = 3;
  pose.position[1] = 1;
  pose.position[2] = 1.2;
  pose.orientation[0] = pose.orientation[3] = 0.70710678;  // w, z: a quarter turn to the left
  for (int i = 0; i < 3; ++i) pose.covariance[i * 7] = 1e-4;
  return pose;
}

/// A blue cup, 1.5 m ahead and 0.4 m below the camera.
anchord::detection_t cup() {
  anchord::detection_t detection{};
  detection.kind = anchord::detection_t::POSITION;
  detection.measurement[0] = 1.5;
  detection.measurement[2] = -0.4;
  detection.num_covariance = 0;  // as configured; or 9 numbers, row-major
  detection.has_score = true;
  detection.score = 0.9;
  detection.attributes = {symbol("class", "cup", 0.8), symbol("color", "blue", 0.7)};
  detection.num_attributes = 2;
  return detection;
}

}  // namespace

int main() {
  lcm::LCM lcm;  // $LCM_DEFAULT_URL or LCM's own, as the daemon's
  if (!lcm.good()) return std::fputs("publish_frame: LCM cannot be opened\n", stderr), 1;
  for (std::int64_t seq = 1;; ++seq) {
    anchord::frame_t frame{};
    frame.utime = now_utime();
    frame.seq = seq;  // lets the daemon count what gets lost
    frame.sensor = "kinect";
    frame.has_pose = true;
    frame.pose = camera_pose();
    frame.view.type = anchord::view_t::CONFIGURED;
    frame.detections = {cup()};  // an empty frame is worth publishing too: nothing is there
    frame.num_detections = 1;
    if (lcm.publish("ANCHORD_DETECTIONS", &frame) != 0) return 1;
    std::printf("frame %lld\n", static_cast<long long>(seq));
    std::fflush(stdout);
    std::this_thread::sleep_for(std::chrono::seconds(1));
  }
}
