#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "perception/camera.h"
#include "perception/explanation.h"
#include "perception/silhouette.h"

namespace anchord {

/// A person that explains foreground.
struct FoundPerson {
  Silhouette silhouette;
  double gain = 0;      ///< log-likelihood won by adding it to the others, over the mean of one
                        ///< that is wholly seen: about 1, less when it overlaps others
  double filled = 0;    ///< share of its body's observable pixels that are foreground
  double observed = 0;  ///< share of its body inside the picture and not behind fixed things
  double alone = 0;     ///< share of that which nobody nearer to the camera covers
};

/// Finds the people on the ground whose silhouettes together explain the foreground: a
/// probabilistic occupancy map (F. Fleuret, J. Berclaz, R. Lengagne, P. Fua, "Multi-camera people
/// tracking with a probabilistic occupancy map", IEEE PAMI 30(2), 2008) of one camera, solved
/// greedily with explaining away: of people who overlap in the picture each must explain pixels
/// that the others do not.
class PersonSearch {
 public:
  struct Settings {
    double height_m = 1.74;            ///< of people: mean
    double height_deviation_m = 0.07;  ///< and standard deviation
    double false_foreground = 0.03;    ///< probability of foreground where nobody is
    double least_gain = 0.2;           ///< of a person that is reported
    int least_foot_row = 0;            ///< no feet above this row
    int rows_below = 24;               ///< feet may be so far below the picture
    int columns_beside = 0;            ///< or beside it
    int step = 4;                      ///< of the grid of first guesses, pixels
    int most = 40;                     ///< people in one frame
  };

  /// `observable`: 8-bit, the picture's size, zero where something fixed hides people.
  PersonSearch(const Camera& camera, const cv::Mat1b& observable, const Settings& settings);

  /// `foreground`: 32-bit float, the probability of each pixel. The same input gives the same
  /// output, in the order in which people were found.
  std::vector<FoundPerson> find(const cv::Mat1f& foreground) const;

 private:
  struct Part {
    cv::Rect area;
    double hit, miss;  ///< gain of a foreground and of a background pixel
  };
  struct Candidate {
    Silhouette silhouette;
    std::vector<Part> parts;
    double full_gain = 0;
  };

  std::vector<Silhouette> explain(Explanation& explanation) const;
  double rough_gain(const Explanation& explanation, const Candidate& candidate) const;
  double gain_with_prior(const Explanation& explanation, const Silhouette& person) const;
  /// Moves everyone to where they explain most, given the others.
  void settle(Explanation& explanation, std::vector<Silhouette>& people) const;
  /// What each wins, given all others: see FoundPerson::gain.
  std::vector<double> gains(Explanation& explanation, const std::vector<Silhouette>& people) const;
  Silhouette refined(const Explanation& explanation, Silhouette person) const;

  Camera camera_;
  cv::Mat1b observable_;
  Settings settings_;
  std::vector<Candidate> candidates_;
};

}  // namespace anchord
