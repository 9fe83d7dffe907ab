#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "core/verification.h"
#include "perception/blob_gauge.h"
#include "perception/camera.h"
#include "perception/detector_settings.h"
#include "perception/empty_scene.h"
#include "perception/person_gauge.h"
#include "perception/placement.h"
#include "perception/roi_mask.h"
#include "perception/sighting.h"
#include "perception/visible_share.h"

namespace anchord {

/// A picture of the camera, with the depth of its pixels where there is a depth image.
struct CameraPicture {
  cv::Mat frame;               ///< 8-bit BGR
  cv::Mat1f depth;             ///< m along the optical axis, 0 where unknown; empty: none
  std::optional<Pose> pose{};  ///< of a carried camera
};

/// Looks for the objects of verification tasks, and only inside their regions of interest (thesis
/// section 3.6): the region is projected into the picture, the object's size added, and no pixel
/// outside that box is read.
///
/// People (class `person`) are sought as PersonDetector does, by the silhouettes that explain what
/// differs from the empty scene, on the ground; of several the one that fits the prediction and the
/// color of the clothes. Everything else is a patch of the color and size that the task or the
/// camera's file gives; in a 2-D world it stands on the ground.
///
/// A carried camera is where the picture's pose has it. Nothing counts as absent but what would be
/// in sight with any pose within the error of that, and nothing as hidden but what the picture
/// has behind something nearer, seen from the task's viewpoint if it has one: a robot that has to
/// turn or drive first is not done. People, who need an empty scene, are not looked for.
///
/// Deterministic: the same pictures and tasks in the same order give the same answers.
class Verifier {
 public:
  /// `scene`: pictures to learn the empty scene from; without any, people are not found (every look
  /// for one is doubtful). A carried camera has none. `dims`: of the world's positions.
  Verifier(const DetectorSettings& settings, const std::vector<cv::Mat>& scene, int dims);

  /// Looks for the task's object. The picture must have the camera's size, and a pose that
  /// check_camera_pose() takes if and only if the camera is carried. The regions must hold for the
  /// time of the picture.
  Sighting look(const CameraPicture& picture, const Task& task);

 private:
  /// The box about the regions, cut out of everything.
  struct Part {
    const Camera camera;  ///< of the part: its pixels are the part's
    CameraPicture picture;
    cv::Rect box;
    cv::Mat1b observable;  ///< zero: outside the mask of the regions, or hidden by something fixed
    std::vector<Placement> places;
    /// Where what is at the places may appear, by the pose's error; without a pose the same.
    std::vector<Placement> apparent;
  };
  struct Candidate;

  Sighting look_for_person(const Part& part, const Task& task);
  Sighting look_for_blob(const Part& part, const Task& task) const;
  /// A blob as what is looked for.
  Candidate candidate(const MeasuredBlob& blob, const Task& task,
                      const std::optional<Pose>& pose) const;
  /// ln of how well a person fits a task, up to a constant.
  double fit(const DetectedPerson& person, const Task& task) const;
  Detection report(const DetectedPerson& person) const;
  /// What it means that nothing was found. `bare`: zero where what is seen may hide it.
  Sighting nothing_found(const Part& part, const Body& body, const cv::Mat1b& bare) const;
  std::array<double, 3> extent_of(const Task& task) const;
  std::vector<std::string> colors_of(const Task& task) const;

  DetectorSettings settings_;
  Camera camera_;
  int dims_;
  std::optional<EmptyScene> scene_;
  PersonGauge gauge_;
};

}  // namespace anchord
