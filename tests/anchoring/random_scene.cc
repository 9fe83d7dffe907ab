#include "tests/anchoring/random_scene.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "tests/anchoring/dice.h"
#include "tests/anchoring/enumeration.h"
#include "tests/anchoring/random_looks.h"
#include "tests/anchoring/random_ranges.h"

namespace anchord::enumeration {
namespace {

using Kind = BehaviourModel::Kind;

constexpr int kColumns = 6, kRows = 5;  ///< of the bounds, in cells

class Maker {
 public:
  Maker(Dice& dice, const Variety& variety) : dice_(dice), variety_(variety) {
    make_world();
    make_attributes();
    make_classes();
    make_sensors();
    if (variety_.looks) add_looks(known(), dice_);
    make_sites();
    make_frames();
    if (variety_.ranged) add_ranges(scene_, dice_);
    for (ObjectClass& c : known().classes)
      for (BehaviourModel& model : c.models)
        if (!model.tracked() && dice_.chance(0.4)) model.stir = dice_.scale(0.03, 0.5);
  }
  Scene take() { return std::move(scene_); }

 private:
  Knowledge& known() { return scene_.knowledge; }

  void make_world() {
    Knowledge& k = known();
    k.limits = kNoLimits;
    k.dims = variety_.three_d ? 3 : 2;
    k.cell = dice_.chance(0.5) ? 1 : 0.5;
    k.bounds_min.head<2>() = k.cell * Eigen::Vector2d(dice_.integer(-3, 3), dice_.integer(-3, 3));
    k.bounds_max.head<2>() = k.bounds_min.head<2>() + k.cell * Eigen::Vector2d(kColumns, kRows);
    k.bounds_max.z() = variety_.three_d ? 4 : 0;
    if (!variety_.somewhere && !variety_.arrivals) return;
    for (const char* name : {"table", "floor"}) {
      Place place;
      place.name = name;
      place.kind = "surface";
      place.region.polygon = polygon(0);
      place.region.z_min = dice_.pick<double>({0, 0.5});
      place.region.z_max = dice_.pick<double>({2, 2.2});
      k.places.push_back(place);
    }
  }

  /// A rectangle or an L along cell borders, either way round, at most `beyond` cells outside the
  /// bounds.
  std::vector<Eigen::Vector2d> polygon(int beyond) {
    const int x0 = dice_.integer(-beyond, kColumns - 2),
              x2 = dice_.integer(x0 + 2, kColumns + beyond);
    const int y0 = dice_.integer(-beyond, kRows - 2), y2 = dice_.integer(y0 + 2, kRows + beyond);
    const int x1 = dice_.integer(x0 + 1, x2 - 1), y1 = dice_.integer(y0 + 1, y2 - 1);
    std::vector<std::pair<int, int>> corners{{x0, y0}, {x2, y0}, {x2, y2}, {x0, y2}};
    if (dice_.chance(0.4)) corners = {{x0, y0}, {x2, y0}, {x2, y1}, {x1, y1}, {x1, y2}, {x0, y2}};
    if (dice_.chance(0.5)) std::reverse(corners.begin(), corners.end());
    std::vector<Eigen::Vector2d> result;
    for (const auto& [x, y] : corners)
      result.push_back(known().bounds_min.head<2>() + known().cell * Eigen::Vector2d(x, y));
    return result;
  }

  void make_attributes() {
    Knowledge& k = known();
    if (variety_.classes) {
      Attribute a;
      a.name = "class";
      a.symbols = {"cup", "box"};
      if (dice_.chance(0.5)) a.symbols.push_back("ball");
      k.attributes.push_back(a);
    }
    if (variety_.attributes) {
      k.attributes.push_back({.name = "color",
                              .kind = Attribute::Kind::kCategorical,
                              .symbols = {"red", "green", "blue"},
                              .unit = "",
                              .predicates = {}});
      k.attributes.push_back({.name = "size",
                              .kind = Attribute::Kind::kScalar,
                              .symbols = {},
                              .unit = "m",
                              .predicates = {{"small", 0, 0.15}, {"large", 0.15, 0.5}},
                              .reference_density = 2});
      if (dice_.chance(0.5)) std::reverse(k.attributes.begin(), k.attributes.end());
    }
    for (std::size_t a = 0; a < k.attributes.size(); ++a)
      if (k.attributes[a].name == "class") k.class_attribute = static_cast<int>(a);
  }

  void make_classes() {
    Knowledge& k = known();
    std::vector<std::string> names{"object"};
    if (k.class_attribute >= 0) names = k.attributes[k.class_attribute].symbols;
    for (const std::string& name : names) {
      ObjectClass c;
      c.name = name;
      make_models(c);
      if (variety_.changes && dice_.chance(0.8)) make_changes(c);
      c.detection_probability = dice_.uniform(0.3, 0.97);
      c.undetected_intensity = dice_.scale(0.01, 1);
      if (variety_.departures) c.departure_rate = dice_.chance(0.2) ? 0 : dice_.scale(0.01, 0.5);
      if (variety_.arrivals) {
        c.arrival_rate = dice_.scale(0.001, 0.1);
        if (dice_.chance(0.5))
          c.arrivals.push_back({.place = dice_.integer(0, 1), .rate = dice_.scale(0.01, 1)});
      }
      k.classes.push_back(c);
    }
    if (variety_.phantoms)
      k.classes[dice_.integer(0, static_cast<int>(names.size()) - 1)].phantom = true;
  }

  void make_changes(ObjectClass& c) {
    const auto& attributes = known().attributes;
    for (std::size_t a = 0; a < attributes.size(); ++a) {
      if (static_cast<int>(a) == known().class_attribute) continue;
      AttributeChange change;
      change.attribute = static_cast<int>(a);
      if (attributes[a].kind == Attribute::Kind::kScalar) {
        change.drift = dice_.scale(1e-4, 1e-2);
      } else if (dice_.chance(0.4)) {
        change.redraw = dice_.scale(0.05, 1);
      } else {
        for (const auto& [from, to] : {std::pair(2, 0), std::pair(0, 1), std::pair(1, 0)})
          if (dice_.chance(0.6)) change.transitions.push_back({from, to, dice_.scale(0.05, 1)});
      }
      c.changes.push_back(change);
    }
  }

  void make_models(ObjectClass& c) {
    const auto tracked = [&](Kind kind) {
      BehaviourModel model;
      model.kind = kind;
      const double size = known().cell;  // R is small against a cell where there is `somewhere`
      model.psd = size * size * dice_.scale(0.003, 0.3);
      if (kind == Kind::kConstantVelocity)
        model.initial_velocity_variance = size * size * dice_.scale(0.01, 0.3);
      if (known().dims == 3 && dice_.chance(0.5))
        model.psd.height *= 0.3, model.initial_velocity_variance.height *= 0.3;
      return model;
    };
    const bool moves = dice_.chance(0.5);
    c.models.push_back(tracked(moves ? Kind::kConstantVelocity : Kind::kConstantPosition));
    c.models[0].initial_weight = 1;
    const bool two = variety_.several_models && dice_.chance(0.8);
    if (two) {
      c.models.push_back(
          tracked(moves == dice_.chance(0.8) ? Kind::kConstantPosition : Kind::kConstantVelocity));
      c.models[1].initial_weight = dice_.chance(0.5) ? dice_.uniform(0.1, 0.5) : 0;
      c.models[0].initial_weight -= c.models[1].initial_weight;
      c.transitions.push_back({0, 1, dice_.scale(0.05, 1)});
      c.transitions.push_back({1, 0, dice_.scale(0.05, 1)});
    }
    if (variety_.undetectable && dice_.chance(0.8)) {
      BehaviourModel hidden = c.models[0];
      hidden.detectable = false;
      hidden.initial_weight = 0;
      const int at = static_cast<int>(c.models.size());
      c.models.push_back(hidden);
      c.transitions.push_back({0, at, dice_.scale(0.05, 1)});
      c.transitions.push_back({at, 0, dice_.scale(0.05, 1)});
    }
    if (variety_.shared && dice_.chance(0.8)) {
      BehaviourModel sharing = tracked(Kind::kConstantPosition);
      sharing.stir = dice_.chance(0.7) ? dice_.scale(0.05, 2) : 0;
      sharing.shared_probability = dice_.uniform(0.5, 0.99);
      for (std::size_t a = 0; a < known().attributes.size(); ++a)
        if (known().attributes[a].kind == Attribute::Kind::kScalar && dice_.chance(0.7))
          sharing.growing = static_cast<int>(a);
      sharing.reach = known().cell * dice_.scale(0.03, 0.6);
      const int at = static_cast<int>(c.models.size());
      c.models.push_back(sharing);
      c.transitions.push_back({0, at, dice_.scale(0.05, 1)});
      c.transitions.push_back({at, 0, dice_.scale(0.05, 1)});
    }
    for (int n = 0; variety_.somewhere && n < 2 && dice_.chance(n == 0 ? 0.9 : 0.3); ++n) {
      BehaviourModel model;
      model.kind = Kind::kSomewhere;
      model.place = n == 0 ? dice_.integer(-1, 1) : (c.models.back().place == 0 ? 1 : 0);
      model.rate = dice_.scale(0.03, 0.5);
      if (dice_.chance(0.2)) {
        model.initial_weight = 0.1 * c.models[0].initial_weight;
        c.models[0].initial_weight -= model.initial_weight;
      }
      if (two && dice_.chance(0.4)) model.found_in = 1;
      c.models.push_back(model);
    }
    if (c.models.back().kind == Kind::kSomewhere && dice_.chance(0.3)) {  // a tracked one not first
      std::rotate(c.models.begin(), c.models.end() - 1, c.models.end());
      for (Transition& t : c.transitions) t = {t.from + 1, t.to + 1, t.rate};
      for (BehaviourModel& m : c.models) m.found_in += m.found_in >= 0;
    }
  }

  void make_sensors() {
    Knowledge& k = known();
    ScoreMemory memory;
    if (variety_.phantoms && dice_.chance(0.7))
      memory = {dice_.uniform(0.2, 0.95), dice_.scale(0.1, 10)};
    for (const char* name : {"default", "left", "right"}) {
      Sensor sensor;
      if (variety_.phantoms) sensor.real_share.rest = dice_.uniform(0.2, 0.9);
      sensor.score_memory.rest = memory;
      sensor.name = name;
      sensor.clutter_density = dice_.scale(0.003, 1);
      for (const ObjectClass& c : k.classes)
        sensor.detection_probability.push_back(dice_.chance(0.5) ? c.detection_probability
                                                                 : dice_.uniform(0.2, 0.97));
      for (const Attribute& a : k.attributes) {
        const std::size_t n = a.symbols.size();
        const bool prior = n > 0 && dice_.chance(0.4), confusion = n > 0 && dice_.chance(0.3);
        sensor.prior.push_back(prior ? dice_.distribution(n, 0.2)
                                     : std::vector<double>(n, 1.0 / static_cast<double>(n)));
        sensor.confusion.emplace_back();
        for (std::size_t s = 0; confusion && s < n; ++s)
          sensor.confusion.back().push_back(dice_.distribution(n, 0.05));
      }
      sensor.identity_doubt = dice_.scale(0.005, 0.5);
      if (variety_.doubled) sensor.double_detection = dice_.uniform(0.01, 0.5);
      const double variance = deviation() * deviation();
      for (int i = 0; i < k.dims * k.dims; ++i)
        sensor.noise.push_back(i % (k.dims + 1) == 0 ? variance : 0);
      if (variety_.views && dice_.chance(0.5)) sensor.view = view();
      if (std::string(name) == "default")
        k.default_sensor = sensor;
      else
        k.sensors.push_back(sensor);
    }
  }

  View view() {
    View view;
    if (!variety_.views || dice_.chance(0.2)) {
      view.type = View::Type::kWorld;
    } else if (!dice_.chance(0.1)) {
      view.type = View::Type::kPolygon;
      for (const Eigen::Vector2d& p : polygon(2)) view.points.push_back({p.x(), p.y()});
    }
    return view;
  }

  /// A standard deviation of detections, m. With `somewhere` the nearest cell border is 8 of them
  /// away, so that the density at z is the density convolved with R, to 1e-15.
  double deviation() {
    return known().cell * (variety_.somewhere ? dice_.uniform(0.02, 0.05) : dice_.scale(0.05, 0.5));
  }

  /// Where detections gather.
  void make_sites() {
    const Knowledge& k = known();
    for (int n = dice_.integer(1, 3); n > 0; --n) {
      int x = dice_.integer(0, kColumns - 1);
      const int y = dice_.integer(0, kRows - 1);
      if (variety_.outside && dice_.chance(0.4)) x = dice_.chance(0.5) ? -1 : kColumns + 1;
      Eigen::Vector3d site = Eigen::Vector3d::Zero();
      site.head<2>() = k.bounds_min.head<2>() + k.cell * Eigen::Vector2d(x + 0.5, y + 0.5);
      if (variety_.three_d) site.z() = dice_.pick<double>({1.2, 1.3, 3});
      sites_.push_back(site);
      if (dice_.chance(0.5)) sites_.push_back(site);
    }
  }

  Detection make_detection(std::size_t frame) {
    const Knowledge& k = known();
    Detection detection;
    const int at = dice_.integer(0, static_cast<int>(sites_.size()) - 1);
    CartesianMeasurement measured;
    for (int i = 0; i < k.dims; ++i) {
      const double spread = variety_.somewhere ? dice_.uniform(-0.1, 0.1) : 0.4 * dice_.normal();
      measured.position.push_back(sites_[at](i) + k.cell * spread);
    }
    if (variety_.three_d) measured.position[2] = std::clamp(measured.position[2], 0.1, 3.9);
    if (dice_.chance(0.8)) {
      Eigen::MatrixXd r = Eigen::MatrixXd::Zero(k.dims, k.dims);
      for (int i = 0; i < k.dims; ++i) r(i, i) = std::pow(deviation(), 2);
      for (int i = 0; variety_.correlated && i < k.dims; ++i)
        for (int j = 0; j < i; ++j)  // below 1 / 2 in size: positive definite in 3-D too
          r(i, j) = r(j, i) = dice_.uniform(-0.45, 0.45) * std::sqrt(r(i, i) * r(j, j));
      measured.covariance.assign(r.data(), r.data() + r.size());
    }
    detection.measurement = measured;
    for (const Attribute& a : k.attributes)
      if (dice_.chance(0.75)) detection.attributes.push_back(report(a, at));
    if (variety_.scores && dice_.chance(0.7))
      detection.score = dice_.pick<double>({0, 0.2, 0.5, 0.7, 0.95, 1});
    if (variety_.verification && frame > 0 && dice_.chance(0.4)) {
      const std::size_t seen = dice_.integer(0, static_cast<int>(frame) - 1);
      const std::size_t n = scene_.frames[seen].detections.size();
      if (n > 0)
        detection.object = reference({seen, static_cast<std::size_t>(dice_.integer(0, n - 1))});
    }
    return detection;
  }

  /// Mostly of the site's own symbol or size, sometimes of another.
  AttributeReport report(const Attribute& attribute, int site) {
    if (attribute.kind == Attribute::Kind::kScalar) {
      const double variance = dice_.scale(1e-4, 1e-2);
      return {attribute.name,
              ScalarReport{0.1 + 0.1 * site + std::sqrt(variance) * dice_.normal(), variance}};
    }
    std::vector<std::string> symbols = attribute.symbols;
    if (attribute.name == "class")  // nobody reports a phantom as one
      std::erase_if(symbols, [&](const std::string& symbol) {
        return known().classes[known().find_class(symbol)].phantom;
      });
    const int n = static_cast<int>(symbols.size());
    const int symbol = dice_.chance(0.8) ? site % n : dice_.integer(0, n - 1);
    SymbolReport r;
    if (dice_.chance(0.2)) {  // a certain one, which the floor holds back
      r.probabilities.emplace_back(symbols[symbol], 1);
    } else if (dice_.chance(0.5)) {  // a partial one
      r.probabilities.emplace_back(symbols[symbol], dice_.uniform(0.4, 0.95));
    } else {
      std::vector<double> p = dice_.distribution(n, 0.05);
      std::swap(p[symbol], *std::max_element(p.begin(), p.end()));
      for (int s = 0; s < n; ++s) r.probabilities.emplace_back(symbols[s], p[s]);
    }
    return {attribute.name, r};
  }

  void make_frames() {
    const auto frames = static_cast<std::size_t>(dice_.integer(2, 4));
    std::vector<std::size_t> detections;
    for (std::size_t t = 0; t < frames; ++t)
      detections.push_back(dice_.chance(0.15) ? 0 : dice_.integer(1, 3));
    while (count_worlds(detections, variety_.departures) > variety_.max_worlds) {
      std::size_t& n = detections[dice_.integer(0, static_cast<int>(frames) - 1)];
      if (n > 0) --n;
    }
    Utime now = 1'700'000'000'000'000;
    for (std::size_t t = 0; t < frames; ++t) {
      Frame frame;
      frame.sensor =
          variety_.sensors ? dice_.pick<std::string>({"left", "right", "spare"}) : "left";
      // One sensor has one frame at an instant.
      bool alone = true;
      for (const Frame& earlier : scene_.frames)
        alone = alone && !(earlier.utime == now && earlier.sensor == frame.sensor);
      if (!alone || !dice_.chance(0.3)) now += from_seconds(dice_.scale(0.05, 2));
      frame.utime = now;
      if (!variety_.views || !dice_.chance(0.2)) frame.view = view();
      scene_.frames.push_back(frame);
      for (std::size_t d = 0; d < detections[t]; ++d) {
        Detection detection = make_detection(t);
        scene_.frames[t].detections.push_back(std::move(detection));
      }
    }
    make_arrival();
  }

  void make_arrival() {
    const auto& frames = scene_.frames;
    for (std::size_t t = 0; t < frames.size(); ++t) scene_.arrival.push_back(t);
    if (!variety_.late) return;
    known().max_lateness = 5;
    for (int swaps = 0; swaps < 8; ++swaps) {
      const std::size_t i = dice_.integer(0, static_cast<int>(frames.size()) - 2);
      const Frame &a = frames[scene_.arrival[i]], &b = frames[scene_.arrival[i + 1]];
      // Those already swapped are left: nothing is later than all frames together take.
      if (a.sensor != b.sensor && a.utime < b.utime &&
          seconds_between(a.utime, frames.back().utime) <= known().max_lateness)
        std::swap(scene_.arrival[i], scene_.arrival[i + 1]);
    }
  }

  Dice& dice_;
  const Variety& variety_;
  Scene scene_;
  std::vector<Eigen::Vector3d> sites_;
};

}  // namespace

Scene random_scene(std::mt19937_64& random, const Variety& variety) {
  Dice dice(random);
  return Maker(dice, variety).take();
}

}  // namespace anchord::enumeration
