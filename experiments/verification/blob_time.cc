// verification_blob_time: how long the verifier takes for a colored blob, as the thesis' cat
// (section 3.8.1: less than 1 ms), in a 640 x 480 picture with a depth image.

#include <chrono>
#include <cstdio>
#include <opencv2/imgproc.hpp>

#include "perception/camera_file.h"
#include "perception/verifier.h"

namespace anchord {
namespace {

constexpr int kLooks = 500;
/// Figure 3.3's cat: black, and as large in all directions since it has no known orientation.
constexpr std::array<double, 3> kCat{0.3, 0.3, 0.3};

int run(const char* camera_file) {
  ConfigurationMistakes mistakes;
  auto settings = read_camera_file(camera_file, mistakes);
  if (!settings) return 2;
  settings->occluders.clear();
  CameraParameters& c = settings->camera;  // a Kinect 1.2 m above the ground that looks along x
  c = pinhole(640, 480, 525);
  c.rotation = {CV_PI / 2, -CV_PI / 2, 0};
  c.translation = {0, 1.2, 0};
  Verifier verifier(*settings, {}, 3);
  const Camera camera(c);
  std::printf("distance_m,pixels_read_percent,mean_ms,found\n");
  for (const double distance : {2.0, 3.0, 4.0, 5.0}) {
    const Eigen::Vector2d middle = camera.project({distance, 0, 0.4});
    const double radius = 525 * kCat[2] / 2 / distance;
    cv::Mat frame(c.height, c.width, CV_8UC3, cv::Scalar(120, 125, 130));
    cv::Mat1f depth(c.height, c.width, 6.0F);
    const cv::Point at(cvRound(middle.x()), cvRound(middle.y()));
    cv::circle(frame, at, cvRound(radius), cv::Scalar::all(5), cv::FILLED);
    cv::circle(depth, at, cvRound(radius), cv::Scalar(distance - 0.12), cv::FILLED);
    RegionOfInterest region;
    region.p = 0.95;
    region.center = {distance, 0, 0.4};
    region.covariance = {0.005, 0, 0, 0, 0.005, 0, 0, 0, 0.005};
    region.radius = 2.8;
    Task task;
    task.object = "cat-1";
    task.object_class = "cat";
    task.regions = {region};
    task.extent = kCat;
    task.appearance = {{"color", SymbolReport{{{"black", 1}}}}};
    int found = 0;
    double looked_at = 0;
    const auto begun = std::chrono::steady_clock::now();
    for (int i = 0; i < kLooks; ++i) {
      const Sighting sighting = verifier.look({frame, depth}, task);
      found += sighting.sight == Sighting::Sight::kFound;
      looked_at += sighting.looked_at;
    }
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begun;
    std::printf("%.1f,%.2f,%.3f,%d/%d\n", distance, 100 * looked_at / kLooks, took.count() / kLooks,
                found, kLooks);
  }
  return 0;
}

}  // namespace
}  // namespace anchord

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  return anchord::run(argc > 1 ? argv[1] : "config/plaza.camera.json");
}
