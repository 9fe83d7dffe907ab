#include "anchoring/map_frame.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/conversion.h"

namespace anchord {
namespace {

constexpr double kLeastSymbol = 1e-6;  // no report is certain
constexpr double kLeastScore = 1e-6;

/// Per symbol of an attribute whether sensors may report it: no phantom is told to be one.
std::vector<char> reportable(const Knowledge& knowledge, int attribute) {
  std::vector<char> out(knowledge.attributes[attribute].symbols.size(), 1);
  if (attribute == knowledge.class_attribute)
    for (std::size_t c = 0; c < out.size(); ++c) out[c] = !knowledge.classes[c].phantom;
  return out;
}

/// A report as a distribution over the symbols that may be reported: what is left over is spread
/// over those not named.
Result<std::vector<double>> distribution(const SymbolReport& report, const Attribute& attribute,
                                         const std::vector<char>& may, const std::string& field) {
  std::vector<double> m(attribute.symbols.size(), -1.0);
  double sum = 0;
  for (const auto& [symbol, p] : report.probabilities) {
    const int s = attribute.find(symbol);
    const std::string at = field + "." + symbol;
    if (s < 0) return invalid(at, "is not a symbol of attribute \"" + attribute.name + "\"");
    if (!(p >= 0 && p <= 1.001)) return invalid(at, "must be a probability, 0 to 1");
    if (!may[s]) return invalid(at, "is a phantom: report what it looks like");
    if (m[s] >= 0) return invalid(at, "is reported twice");
    m[s] = p;
    sum += p;
  }
  if (!(sum > 0)) return invalid(field, "its probabilities must not all be zero");
  if (sum > 1.001) return invalid(field, "its probabilities must sum to at most 1");
  std::ptrdiff_t unnamed = 0;
  for (std::size_t s = 0; s < m.size(); ++s) unnamed += may[s] && m[s] < 0;
  double total = 0;
  for (std::size_t s = 0; s < m.size(); ++s) {
    if (m[s] < 0) m[s] = std::max(0.0, 1 - sum) / static_cast<double>(unnamed);
    m[s] = may[s] ? std::max(m[s], kLeastSymbol) : 0;
    total += m[s];
  }
  for (double& p : m) p /= total;
  return m;
}

/// m(s) / pi(s), or with a confusion matrix what the report is worth under each true symbol. That
/// of what looks like anything is 1.
std::vector<double> likelihood_ratio(const std::vector<double>& m, const Sensor& sensor,
                                     int attribute, const std::vector<char>& may) {
  const std::size_t n = m.size();
  const bool confused = !sensor.confusion.empty() && !sensor.confusion[attribute].empty();
  const bool uniform = confused || sensor.prior.empty() || sensor.prior[attribute].empty();
  std::vector<double> ratio(n, 1.0), prior(n, 1.0);
  double reported = 0, total = 0;
  for (std::size_t s = 0; s < n; ++s) {
    if (!may[s]) continue;
    ratio[s] = confused ? 0 : m[s];
    for (std::size_t j = 0; confused && j < n; ++j)
      ratio[s] += m[j] * sensor.confusion[attribute][s][j];
    if (!uniform) prior[s] = sensor.prior[attribute][s];
    reported += ratio[s];
    total += prior[s];
  }
  for (std::size_t s = 0; s < n; ++s)
    if (may[s]) ratio[s] *= total / (reported * prior[s]);
  return ratio;
}

Status read_attributes(const Detection& from, const std::string& at, const Knowledge& knowledge,
                       const Sensor& sensor, MapDetection& to) {
  std::vector<char> seen(knowledge.attributes.size(), 0);
  for (const AttributeReport& report : from.attributes) {
    const std::string field = at + ".attributes." + report.name;
    const int a = knowledge.find_attribute(report.name);
    if (a < 0) return invalid(field, "is not an attribute of the configuration");
    if (seen[a]++) return invalid(field, "is reported twice");
    const Attribute& attribute = knowledge.attributes[a];
    if (const auto* scalar = std::get_if<ScalarReport>(&report.value)) {
      if (attribute.kind != Attribute::Kind::kScalar)
        return invalid(field, "is categorical: give probabilities of its symbols");
      if (!std::isfinite(scalar->mean)) return invalid(field + ".mean", "must be finite");
      if (!(scalar->variance > 0) || !std::isfinite(scalar->variance))
        return invalid(field + ".variance", "must be positive and finite");
      to.attributes.push_back({a, {}, scalar->mean, scalar->variance});
      continue;
    }
    if (attribute.kind != Attribute::Kind::kCategorical)
      return invalid(field, "is a scalar: give its mean and variance");
    const auto may = reportable(knowledge, a);
    auto m = distribution(std::get<SymbolReport>(report.value), attribute, may, field);
    if (!m) return m.error();
    auto ratio = likelihood_ratio(*m, sensor, a, may);
    if (a == knowledge.class_attribute) {
      to.has_class = true;
      to.class_ratio = std::move(ratio);
      for (std::size_t c = 0; c < knowledge.classes.size(); ++c)
        if (const int look = knowledge.classes[c].looks_like; look >= 0)
          to.class_ratio[c] = to.class_ratio[look];
      to.label = static_cast<int>(std::max_element(m->begin(), m->end()) - m->begin());
    } else {
      to.attributes.push_back({a, std::move(ratio), 0, 0});
    }
  }
  return Done{};
}

Result<Gaussian> read_position(const Detection& from, const std::optional<Pose>& pose,
                               const Sensor& sensor, int dims) {
  if (const auto* polar = std::get_if<PolarMeasurement>(&from.measurement)) {
    if (!polar->variance.empty()) return to_map(*polar, pose, dims);
    if (sensor.polar_noise.empty())
      return invalid("polar.variance", "is missing, and sensor \"" + sensor.name +
                                           "\" has no polar noise configured");
    PolarMeasurement filled = *polar;
    filled.variance = sensor.polar_noise;
    return to_map(filled, pose, dims);
  }
  const auto& cartesian = std::get<CartesianMeasurement>(from.measurement);
  if (cartesian.position.size() == static_cast<std::size_t>(dims) && !cartesian.covariance.empty())
    return to_map(cartesian, pose, dims);
  CartesianMeasurement filled = cartesian;
  // A 2-D world takes 3-D reports from encodings that always carry three numbers.
  if (dims == 2 && filled.position.size() == 3 && filled.covariance.size() != 9)
    filled.position.pop_back();
  if (filled.covariance.empty()) {
    if (sensor.noise.empty())
      return invalid("covariance",
                     "is missing, and sensor \"" + sensor.name + "\" has no noise configured");
    filled.covariance = sensor.noise;
  }
  return to_map(filled, pose, dims);
}

/// l(z | clutter): that of what it looks like.
double clutter_ratio(const MapDetection& z, const Sensor& sensor) {
  if (sensor.clutter_looks.empty()) return 1;
  return std::inner_product(z.class_ratio.begin(), z.class_ratio.end(),
                            sensor.clutter_looks.begin(), 0.0);
}

/// What a score says: against clutter, and of phantoms.
void take_score(double score, const Background& background, const Sensor& sensor, MapDetection& z) {
  const double p = std::clamp(score, kLeastScore, 1 - kLeastScore);
  const auto [a, b, per_m] = sensor.score_calibration.at(z.label);
  const double logit = a + b * (std::log(p) - std::log1p(-p)) + per_m * z.range;
  z.log_odds = logit;
  z.log_clutter -= logit;
  if (!background.has_phantoms) return;
  const double share = sensor.real_share.at(z.label);
  z.score = {logit - std::log(share / (1 - share)), sensor.score_memory.at(z.label)};
  for (int c = 0; c < background.classes(); ++c)
    if (background.object_class(c).phantom) z.class_ratio[c] *= std::exp(-z.score->log_ratio);
}

Result<MapDetection> place_detection(const Detection& from, const Frame& frame,
                                     const std::string& at, const Background& background,
                                     const Sensor& sensor) {
  MapDetection to;
  auto position = read_position(from, frame.pose, sensor, background.dims);
  if (!position) return invalid(at + "." + position.error().field, position.error().message);
  to.position = *position;
  if (frame.pose) {
    const auto& [x, y, z] = frame.pose->position;
    to.range = (to.position.mean - Eigen::Vector3d(x, y, background.dims == 3 ? z : 0)).norm();
  }
  for (const DetectionProbability& p : sensor.detection_probability)
    to.p_detected.push_back(p.at(to.range));
  to.class_ratio.assign(background.classes(), 1.0);
  if (auto read = read_attributes(from, at, background.knowledge, sensor, to); !read)
    return read.error();
  to.log_clutter = std::log(sensor.clutter_density * clutter_ratio(to, sensor));
  if (from.score) {
    if (!(*from.score >= 0 && *from.score <= 1))
      return invalid(at + ".score", "must be a probability, 0 to 1");
    take_score(*from.score, background, sensor, to);
  }
  if (from.yaw) {
    if (!std::isfinite(*from.yaw)) return invalid(at + ".yaw", "must be finite");
    to.yaw = yaw_in_map(*from.yaw, frame.pose);
  }
  to.object = from.object;
  for (const Footprint* place : background.searched())
    to.in_places.emplace_back(place, MeasuredIn::of(to.position, *place));
  return to;
}

/// FNV-1a: the same on every machine.
std::uint32_t number_of(const std::string& robot, const std::string& sensor) {
  std::uint32_t number = 2166136261u;
  for (const std::string* name : {&robot, &sensor})
    for (std::size_t i = 0; i <= name->size(); ++i)  // its end, too
      number = (number ^ static_cast<unsigned char>(name->c_str()[i])) * 16777619u;
  return number;
}

}  // namespace

MeasuredIn MapDetection::in(const Footprint& place) const {
  const auto known = std::find_if(in_places.begin(), in_places.end(),
                                  [&](const auto& in) { return in.first == &place; });
  return known == in_places.end() ? MeasuredIn::of(position, place) : known->second;
}

Result<MapFrame> place_in_map(const Frame& frame, const Background& background) {
  if (frame.utime < kEarliestUtime || frame.utime > kLatestUtime)
    return invalid("utime", "must lie in the years 2000 to 2100, in microseconds since 1970");
  if (frame.sensor.empty()) return invalid("sensor", "must name the sensor");
  if (frame.detections.size() > kMaxDetections)
    return Error{ErrorCode::kTooLarge, "detections",
                 "has " + std::to_string(frame.detections.size()) + " entries, more than " +
                     std::to_string(kMaxDetections)};
  if (frame.pose)
    if (auto good = check_pose(*frame.pose); !good) return good.error();

  MapFrame out;
  out.utime = frame.utime;
  out.robot = frame.robot;
  out.sensor_name = frame.sensor;
  out.viewer = number_of(frame.robot, frame.sensor);
  out.sensor = &background.knowledge.sensor(frame.sensor);
  const View view = frame.view ? *frame.view : out.sensor->view.value_or(View{});
  auto placed = MapView::place(view, frame.pose, background.dims);
  if (!placed) return placed.error();
  out.view = *placed;
  if (frame.pose) {
    const auto& [x, y, z] = frame.pose->position;
    out.eye.emplace(x, y, background.dims == 3 ? z : 0.0);
  }
  out.detections.reserve(frame.detections.size());
  for (std::size_t i = 0; i < frame.detections.size(); ++i) {
    auto detection =
        place_detection(frame.detections[i], frame, "detections[" + std::to_string(i) + "]",
                        background, *out.sensor);
    if (!detection) return detection.error();
    out.detections.push_back(std::move(*detection));
  }
  return out;
}

}  // namespace anchord
