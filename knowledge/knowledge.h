#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/frame.h"
#include "geometry/by_axis.h"
#include "geometry/region.h"
#include "geometry/walls.h"
#include "knowledge/maintenance.h"

namespace anchord {

/// What is known beforehand: classes, attributes, places and sensors, as the configuration says.
/// Immutable once read. Names are turned into indices here, so that the engine compares integers.

/// A behaviour model of a class: one density over the state, and how it moves in time.
struct BehaviourModel {
  enum class Kind { kConstantPosition, kConstantVelocity, kSomewhere };
  Kind kind = Kind::kConstantPosition;
  ByAxis psd;  ///< constant_position: position_psd, m^2/s; constant_velocity: m^2/s^3
  ByAxis initial_velocity_variance;  ///< constant_velocity, (m/s)^2
  int place = -1;                    ///< somewhere: index of its place, -1 for the world's bounds
  double rate = 0;                   ///< somewhere: 1/s at which every tracked model enters it
  /// somewhere: index of the model that an object is in that has been found; -1: the class's first
  /// tracked one that is detectable and shares no detections.
  int found_in = -1;
  double initial_weight = 0;  ///< in a new anchor; those of a class sum to 1, somewhere has 0
  bool detectable = true;
  /// constant_position only: an object in it shares a detection with others that it touches; with
  /// this probability one within reach hides it if it gives none itself. 0: it does not share.
  double shared_probability = 0;
  double reach = 0;  ///< m: how far from it along each axis such a detection is, one sigma
  double stir = 0;   ///< 1/s at which that place among the others, or in `somewhere`, is forgotten
  /// Index of a scalar in which such a detection exceeds each of its objects; -1: none.
  int growing = -1;
  bool implied = false;  ///< somewhere: not configured; a leaf has it only after an event

  bool operator==(const BehaviourModel&) const = default;
  bool tracked() const { return kind != Kind::kSomewhere; }
  bool shares() const { return shared_probability > 0; }
  /// Whether an object moves in it as in the other, both tracked, whatever else is different.
  bool moves_like(const BehaviourModel& other) const {
    return tracked() && kind == other.kind && psd == other.psd && !shares() && !other.shares();
  }
};

/// `constant_position`, `constant_velocity`, `somewhere`.
const char* to_string(BehaviourModel::Kind kind);

struct Transition {
  int from = 0, to = 0;  ///< indices of the class's models, or of an attribute's symbols
  double rate = 0;       ///< 1/s
  bool operator==(const Transition&) const = default;
};

/// Arrivals concentrated somewhere, beside the uniform rate.
struct Arrival {
  int place = -1;  ///< uniform over it, or, if -1, normal:
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double rate = 0;  ///< expected arrivals per second, over the whole of it
  /// Normal only: they go on by the class's first detectable tracked model before they are seen.
  struct Motion {
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< mean, m/s
    std::optional<Eigen::Matrix3d> velocity_covariance;  ///< else the model's initial variance
    double at_start = 0;  ///< expected number that have just arrived as the first frame comes
  };
  /// None: they stay where they arrive until they are seen.
  std::optional<Motion> motion = std::nullopt;
};

/// How an attribute of an object changes by itself: a banana ripens, a candle burns down.
struct AttributeChange {
  int attribute = 0;
  double redraw = 0;  ///< categorical: 1/s at which the symbol is drawn anew, each as probable
  std::vector<Transition> transitions;  ///< categorical: between symbols, by index; or redraw
  double drift = 0;                     ///< scalar: by which the variance grows, unit^2/s
  bool operator==(const AttributeChange&) const = default;
};

/// p_D, of what is r m from the sensor: logit p_D = logit near + per_m r.
struct DetectionProbability {
  double near = 0.9;  ///< 0 to below 1; above 0 where per_m is not 0
  double per_m = 0;

  DetectionProbability(double everywhere = 0.9) : near(everywhere) {}
  DetectionProbability(double close, double per_metre) : near(close), per_m(per_metre) {}

  /// Where it depends on the distance at all it is within 1e-6 and 1 - 1e-6.
  double at(double range) const { return per_m == 0 ? near : fallen(range); }
  bool operator==(const DetectionProbability&) const = default;

 private:
  double fallen(double range) const;
};

struct ObjectClass {
  std::string name;
  bool phantom = false;  ///< what sensors report though it is no object: in no answer
  int looks_like = -1;   ///< of a phantom: it is reported as this class is; -1: as anything
  std::vector<BehaviourModel> models;
  std::vector<Transition> transitions;
  std::vector<AttributeChange> changes;  ///< at most one for each attribute but `class`
  DetectionProbability detection_probability;
  double arrival_rate = 0;  ///< beta_c, uniform part, per m^d and s
  std::vector<Arrival> arrivals;
  double departure_rate = 0;                         ///< mu_c, 1/s
  double undetected_intensity = 0;                   ///< lambda_c at the start, per m^d
  Eigen::Vector3d extent = Eigen::Vector3d::Zero();  ///< length, width, height, m; zeros: unknown
};

struct Predicate {
  std::string name;
  double min = 0, max = 0;  ///< the symbol holds for values in [min, max]; may be infinite
};

struct Attribute {
  enum class Kind { kCategorical, kScalar };
  std::string name;
  Kind kind = Kind::kCategorical;
  std::vector<std::string> symbols;   ///< categorical
  std::string unit;                   ///< scalar
  std::vector<Predicate> predicates;  ///< scalar, in the order of their bounds
  double reference_density = 1;       ///< scalar, per unit

  /// Index of a symbol (categorical) or predicate (scalar), or -1.
  int find(std::string_view symbol) const;
};

struct Place {
  std::string name;
  std::string kind;
  int parent = -1;
  int depth = 0;  ///< number of ancestors
  Region region;
};

/// How alike the scores of one thing are, given what it is, beyond what that explains.
struct ScoreMemory {
  double share = 0;    ///< of their variance that lasts, 0 to below 1; 0: each is news
  double seconds = 1;  ///< for how long: its correlation falls as exp(-t / seconds)
};

/// What counts of a score p at a distance of r m: logit p' = a + b logit p + per_m r, b > 0.
struct ScoreCalibration {
  double a = 0, b = 1, per_m = 0;
};

/// A setting that may differ by the class that a detection is reported as, most probably.
template <typename T>
struct ByLabel {
  T rest{};
  std::vector<T> of;  ///< per class; empty: `rest` for all

  const T& at(int label) const {
    return of.empty() || label < 0 ? rest : of[static_cast<std::size_t>(label)];
  }
};

struct Sensor {
  std::string name;
  double clutter_density = 1e-3;      ///< kappa, per frame and m^d
  std::vector<double> clutter_looks;  ///< shares of it that look like each class; or empty
  std::vector<DetectionProbability> detection_probability;  ///< per class
  std::optional<View> view;                                 ///< sensor frame
  std::vector<double> noise;        ///< row-major covariance, d*d numbers; empty: none configured
  std::vector<double> polar_noise;  ///< variances of range, bearing, elevation; empty: none
  /// Per attribute: the prior pi over its symbols (sums to 1, each above 0); uniform unless
  /// configured, empty for a scalar.
  std::vector<std::vector<double>> prior;
  /// Per attribute: C[true][reported], rows sum to 1; empty where there is none. It goes before
  /// the prior.
  std::vector<std::vector<std::vector<double>>> confusion;
  ByLabel<ScoreCalibration> score_calibration;
  /// Of its detections, those of objects, 0 to 1: what a score is held against to tell phantoms.
  ByLabel<double> real_share{0.5, {}};
  ByLabel<ScoreMemory> score_memory;
  double pose_floor = 0;  ///< m^2
  double identity_doubt = 0.01;
  double double_detection = 0;  ///< how often it reports what it reports once more in one frame
  std::optional<Verification> verification;  ///< none: not used for tasks
};

/// What bounds the work. All off (0; gate 1): the engine is exact.
struct Limits {
  int max_hypotheses = 100;          ///< per cluster; 0: no bound
  double min_weight = 1e-6;          ///< of a hypothesis within its cluster
  double gate_probability = 0.9999;  ///< 1: no gate
  int scan_depth = 20;               ///< frames; 0: none
  double min_existence = 1e-4;       ///< of a leaf
  double min_probability = 1e-6;     ///< of an unnamed anchor not seen for scan_depth frames
  double min_symbol = 1e-6;          ///< belief in a symbol after an update: none is ruled out
  double frame_budget = 0;           ///< s, what a frame may take; 0: no bound
};

/// How long the log keeps frames and events, see docs/operations.md. Nothing here touches the
/// belief.
struct LogLimits {
  double keep = 0;             ///< s; older ones may go; 0: none does for its age
  std::int64_t max_bytes = 0;  ///< of the log's file; 0: no bound
  double history_grain = 1;    ///< s of frames' time at least between two looks for histories
};

struct Knowledge {
  /// The configuration, includes merged and comments gone, with its keys in order: reading that
  /// text gives this knowledge again. Empty where it was not read from one.
  std::string text;
  /// Of what of that text touches the belief: all but `maintenance`, `log` and each sensor's
  /// `verification`. Of the same one, the same.
  std::uint64_t fingerprint = 0;
  /// Of all of that text: what checkpoints of older programs have for a fingerprint.
  std::uint64_t whole_fingerprint = 0;
  std::string map_frame = "map";
  int dims = 3;
  Eigen::Vector3d bounds_min = Eigen::Vector3d::Zero();  ///< z = 0 in a 2-D world
  Eigen::Vector3d bounds_max = Eigen::Vector3d::Zero();
  double cell = 0.25;         ///< m
  double max_lateness = 0.5;  ///< s
  double max_leap = 600;      ///< s that a frame may be ahead of the newest one and of the clock
  std::vector<Wall> walls;    ///< neither sight nor way passes
  std::vector<Place> places;
  std::vector<Attribute> attributes;
  int class_attribute = -1;          ///< index of the attribute `class`, or -1
  std::vector<ObjectClass> classes;  ///< one per symbol of `class`, in order; else one, `object`
  std::vector<Sensor> sensors;       ///< the named ones
  Sensor default_sensor;
  Limits limits;
  Maintenance maintenance;
  LogLimits log;

  int find_place(std::string_view name) const;      ///< or -1
  int find_attribute(std::string_view name) const;  ///< or -1
  int find_class(std::string_view name) const;      ///< or -1
  /// The sensor's own settings, else the default's.
  const Sensor& sensor(std::string_view name) const;
  /// The bounds as a region.
  Region world() const;
};

}  // namespace anchord
