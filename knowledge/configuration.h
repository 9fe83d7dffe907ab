#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "knowledge/knowledge.h"

namespace anchord {

/// Something wrong in a configuration.
struct ConfigurationMistake {
  std::string path;     ///< where, such as `classes.cup.models[1].place`; empty: the whole file
  std::string message;  ///< what is wrong, and what would be right

  /// "path: message", or the message alone.
  std::string text() const { return path.empty() ? message : path + ": " + message; }
  bool operator==(const ConfigurationMistake&) const = default;
};
using ConfigurationMistakes = std::vector<ConfigurationMistake>;

/// What a configuration says, or everything that is wrong with it, in the order of the file's
/// sections.
class [[nodiscard]] Configuration {
 public:
  Configuration(Knowledge knowledge) : content_(std::move(knowledge)) {}
  Configuration(ConfigurationMistakes mistakes) : content_(std::move(mistakes)) {}

  bool ok() const { return std::holds_alternative<Knowledge>(content_); }
  /// Only where ok().
  const Knowledge& knowledge() const { return std::get<Knowledge>(content_); }
  /// Empty where ok().
  ConfigurationMistakes mistakes() const {
    return ok() ? ConfigurationMistakes{} : std::get<ConfigurationMistakes>(content_);
  }

 private:
  std::variant<Knowledge, ConfigurationMistakes> content_;
};

/// Reads a configuration: one JSON file in UTF-8, comments (`//`, `/* */`) allowed.
///
/// `include` (a path or an array of paths, relative to the file that says it) takes other files
/// in below this one: objects merge key by key, a later file wins over an earlier one and the
/// including file over them all, the arrays `places` are joined. A file included twice counts once.
/// Where a file cannot be had or is no JSON, that is all that is said: nothing else could be sure.
///
/// Unknown keys are mistakes. What may be left out, and what then holds:
/// - `world`: `frame` "map", `dimensions` 3, `max_lateness` 0.5 s, `max_leap` 600 s, `cell`
///   0.25 m, doubled until the world has at most kMaxCells cells. `bounds` may not be left out.
///   No `walls`; one is [[x, y], [x, y]], or {"line": that, "z": [least, most]} (default: of any
///   height).
/// - `places[]`: `kind` "", `parent` none, `z` the world's own.
/// - a scalar attribute: `unit` "", no `predicates` (a bound may be null: none on that side; they
///   are ordered by their bounds), `reference_density` 1 over the span of the finite predicate
///   bounds, else 1.
/// - a class: each key by itself from `classes.default`, then from the built-in class: a
///   constant_velocity model with `acceleration_psd` 0.1 m^2/s^3 and `initial_velocity_variance`
///   0.01 (m/s)^2, beside it `somewhere` in the world at `rate` 0.001 /s;
///   `detection_probability` 0.9 (or [p, c]: logit p + c range); `undetected_intensity` 0.01 per
///   m^d, `arrival_rate` 1e-4 per m^d and s, `departure_rate` 0; no `arrivals`, no `extent`, no
///   `changes`, `phantom` false (not to be set in `classes.default`; one class must be none),
///   `looks_like` anything (a class that is no phantom, for one that is). Changes are by attribute:
///   of a scalar {"drift": unit^2/s}; of a categorical one {"redraw": 1/s}, or
///   {"transitions": [{"from", "to", "rate"}]} between at most kMostChanging of its symbols.
///   `transitions` count the models of the class that has them; a class with `models` of its own
///   that those of `classes.default` do not fit must have its own.
/// - a model: `position_psd` 0.001, `acceleration_psd` 0.1, `initial_velocity_variance` 0.01,
///   `vertical` 1 (those numbers in height, over those in the plane), `place` the world, `rate`
///   0.001, `detectable` true, `initial_weight` 0 (1 for the first tracked model where no model has
///   one). Weights are normalised; somewhere models have none.
/// - a sensor: each key by itself from `sensors.default`, then `clutter_density` 1e-3 per m^d, no
///   `view` and no `noise`, `score_calibration` [0, 1, 0] (scores count as logit p' = a + b logit p
///   + c range), `real_share` 0.5, `score_memory` {`share` 0, `seconds` 1}, `pose_floor` 0,
///   `identity_doubt` 0.01. Its `detection_probability` (as a class's, or an object of such by
///   class, in which "default" stands for those not named) goes before that of `sensors.default`,
///   and that before the class's own. `noise` is a position covariance (row-major, sensor frame),
///   or an object with `covariance`, that, and `polar`, the variances of range, bearing and
///   elevation. `prior` and `confusion` are by attribute. A distribution that names only some
///   symbols spreads what is left evenly over the others, and is normalised; priors are kept above
///   1e-6. A true symbol without a row in `confusion` is reported as itself. Where there is a
///   confusion the prior has no effect.
/// - a sensor's `verification` (none: it is not used for verification tasks): `mount` {"position",
///   "orientation"} of the sensor in the robot's base (default: the base itself), `moves_base`
///   true, `cost` 0, `dwell` 0 s, `noise` {class: covariance, "default": covariance}, default the
///   sensor's own position covariance. It needs a view that sees something, in the sensor's frame.
/// - `hypotheses`: `max` 100, `min_weight` 1e-6, `gate_probability` 0.9999, `scan_depth` 20,
///   `min_existence` 1e-4; `min_probability` a hundredth of that; `min_symbol` 1e-6, or
///   `min_weight` where that is less.
/// - `maintenance`: `planner` "greedy" (or "lookahead"), `threshold` 1 nat, `omega` 0.75,
///   `gain_norm` 5 nat, `cost_scale` the diagonal of the bounds, `speed` 0.5 m/s, `step` 1 s,
///   `clearance` 0.3 m, `horizon` 4, `timeout` 60 s, `enabled` false;
///   `actions` grab and navigate verify "object", release "none".
/// - `log`: `keep` 0 s and `max_bytes` 0 (frames and events are kept for ever), `history_grain` 1
/// s.
Configuration read_configuration(const std::filesystem::path& file);

/// The same from memory. Includes are relative to `directory`; if that is empty, they are mistakes
/// and no file is touched.
Configuration parse_configuration(std::string_view text,
                                  const std::filesystem::path& directory = {});

/// Most symbols of one attribute that `transitions` may join.
inline constexpr std::size_t kMostChanging = 20;

/// Most cells that the world may have (Grid): the belief in undetected objects is kept per cell.
inline constexpr double kMaxCells = 4e6;

}  // namespace anchord
