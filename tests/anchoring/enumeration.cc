#include "tests/anchoring/enumeration.h"

#include <cmath>
#include <cstdlib>
#include <utility>

#include "tests/anchoring/enumerated_object.h"

namespace anchord::enumeration {
namespace {

const Sensor& sensor_of(const Knowledge& knowledge, const Frame& frame) {
  for (const Sensor& sensor : knowledge.sensors)
    if (sensor.name == frame.sensor) return sensor;
  return knowledge.default_sensor;
}

/// lambda_c per cell, and what outside the bounds stays at its start value.
class Undetected {
 public:
  Undetected(const Knowledge& knowledge, const Cells& cells)
      : knowledge_(knowledge),
        cells_(cells),
        lambda_(static_cast<int>(knowledge.classes.size()), cells.count()),
        beta_(lambda_) {
    for (int c = 0; c < lambda_.rows(); ++c) {
      const ObjectClass& k = knowledge.classes[c];
      lambda_.row(c).setConstant(k.undetected_intensity);
      beta_.row(c).setConstant(k.arrival_rate);
      for (const Arrival& arrival : k.arrivals) {
        if (arrival.place < 0) std::abort();
        beta_.row(c) += arrival.rate / cells.volume() *
                        extent(knowledge, cells, arrival.place).uniform.transpose();
      }
    }
  }

  void predict(double dt) {
    for (int c = 0; c < lambda_.rows(); ++c) {
      const double mu = knowledge_.classes[c].departure_rate;
      const double stay = std::exp(-mu * dt), time = mu > 0 ? -std::expm1(-mu * dt) / mu : dt;
      lambda_.row(c) = (lambda_.row(c) * stay + beta_.row(c) * time).eval();
    }
  }

  /// Returns how many detections of clutter and of undetected objects were to be expected.
  double look(const Sensor& sensor, const Sight& sight) {
    double expected = 0;
    for (int i = 0; i < cells_.count(); ++i) {
      if (!sight.contains(cells_.centre(i))) continue;
      const Eigen::VectorXd p = detection_probabilities(
          knowledge_, sensor, cells_.range(i, cells_.floor, cells_.ceiling, sight));
      expected += (sensor.clutter_density + p.dot(lambda_.col(i))) * cells_.volume();
      for (int c = 0; c < lambda_.rows(); ++c) lambda_(c, i) *= 1 - p(c);
    }
    return expected;
  }

  /// Each class's term of e(z).
  Eigen::VectorXd terms(const Sensor& sensor, const Measurement& z) const {
    Eigen::VectorXd e =
        detection_probabilities(knowledge_, sensor, z.range).cwiseProduct(z.class_ratio);
    const int cell = cells_.find(z.position);
    for (int c = 0; c < e.size(); ++c) {
      e(c) *= cell < 0 ? knowledge_.classes[c].undetected_intensity : lambda_(c, cell);
      if (knowledge_.classes[c].phantom && z.score) e(c) *= std::exp(-*z.score);
    }
    return e;
  }

  std::vector<double> expected() const {
    std::vector<double> result;
    for (int c = 0; c < lambda_.rows(); ++c)
      result.push_back(knowledge_.classes[c].phantom ? 0 : lambda_.row(c).sum() * cells_.volume());
    return result;
  }

 private:
  const Knowledge& knowledge_;
  const Cells& cells_;
  Eigen::MatrixXd lambda_, beta_;  ///< class x cell
};

/// A frame as every world meets it.
struct Step {
  double dt = 0;  ///< since the frame before, s
  const Sensor* sensor = nullptr;
  Sight sight;
  std::vector<Measurement> detections;
  std::vector<Eigen::VectorXd> terms;           ///< of e(z), per detection
  std::vector<std::optional<ObjectKey>> named;  ///< per detection
};

/// A detection may be a surer one, or an earlier one as sure, reported once more.
void repeat(const Sensor& sensor, std::vector<Measurement>& detections) {
  for (std::size_t z = 0; z < detections.size(); ++z)
    for (std::size_t first = 0; first < detections.size(); ++first) {
      const double more = detections[first].log_odds - detections[z].log_odds;
      if (more > 0 || (more == 0 && first < z))
        detections[z].clutter +=
            sensor.double_detection *
            normal_density(detections[z].position, detections[first].position,
                           detections[first].covariance + detections[z].covariance);
    }
}

struct World {
  struct Member {
    ObjectKey key;
    bool exists = true;    ///< or has departed
    bool detected = true;  ///< in the frame at hand
    Object object;
  };
  double weight = 1;
  std::vector<Member> members;
  /// [frame][detection]: the object that it came from; none if it is clutter.
  std::vector<std::vector<std::optional<ObjectKey>>> origins;
};

class Enumeration {
 public:
  Enumeration(const Knowledge& knowledge, const std::vector<Frame>& frames)
      : knowledge_(knowledge), laws_(knowledge) {
    Undetected undetected(knowledge, laws_.cells());
    for (std::size_t t = 0; t < frames.size(); ++t) {
      Step step;
      step.sensor = &sensor_of(knowledge, frames[t]);
      step.sight = Sight::of(frames[t], *step.sensor, knowledge.dims);
      if (t > 0) step.dt = seconds_between(frames[t - 1].utime, frames[t].utime);
      undetected.predict(step.dt);
      for (const Detection& detection : frames[t].detections) {
        step.detections.push_back(measure(knowledge, *step.sensor, detection, step.sight));
        step.terms.push_back(undetected.terms(*step.sensor, step.detections.back()));
        step.named.push_back(parse_reference(detection.object));
      }
      repeat(*step.sensor, step.detections);
      belief_.expected_detections +=
          undetected.look(*step.sensor, step.sight) +
          step.sensor->double_detection * static_cast<double>(step.detections.size());
      steps_.push_back(std::move(step));
    }
    prepare(undetected);
    predict(0, 0, World{});
    normalise();
  }

  EnumeratedBelief take() { return std::move(belief_); }

 private:
  /// Every object stays or has left since the frame before.
  void predict(std::size_t t, std::size_t k, World world) {
    if (t == steps_.size()) return record(world);
    if (k == world.members.size()) {
      world.origins.emplace_back();
      return associate(t, std::move(world));
    }
    if (!world.members[k].exists) return predict(t, k + 1, std::move(world));
    World left = world;
    world.members[k].detected = false;
    const double leaves = laws_.predict(world.members[k].object, steps_[t].dt);
    if (leaves > 0) {
      left.weight *= leaves;
      left.members[k].exists = false;
      predict(t, k + 1, std::move(left));
    }
    world.weight *= 1 - leaves;
    predict(t, k + 1, std::move(world));
  }

  /// The next detection is clutter, new, or comes from an object that has none yet.
  void associate(std::size_t t, World world) {
    const Step& step = steps_[t];
    const std::size_t d = world.origins[t].size();
    if (d == step.detections.size()) return miss(t, std::move(world));
    const Measurement& z = step.detections[d];
    const bool named = step.named[d].has_value();
    const double doubt = named ? step.sensor->identity_doubt : 1;

    World clutter = world;
    clutter.weight *= z.clutter * doubt;
    clutter.origins[t].push_back(std::nullopt);
    associate(t, std::move(clutter));

    if (step.terms[d].sum() > 0) {
      World born = world;
      born.weight *= step.terms[d].sum() * doubt;
      const ObjectKey key{t, d};
      born.members.push_back({key, true, true, laws_.born(z, step.sight, step.terms[d])});
      born.origins[t].push_back(key);
      associate(t, std::move(born));
    }

    for (std::size_t k = 0; k < world.members.size(); ++k) {
      if (!world.members[k].exists || world.members[k].detected) continue;
      World seen = world;
      World::Member& member = seen.members[k];
      const double g = laws_.detect(member.object, *step.sensor, step.sight, z);
      if (g == 0) continue;
      seen.weight *= g * (named && *step.named[d] == member.key ? 1 : doubt);
      member.detected = true;
      seen.origins[t].push_back(member.key);
      associate(t, std::move(seen));
    }
  }

  void miss(std::size_t t, World world) {
    for (World::Member& member : world.members) {
      if (member.exists && !member.detected)
        world.weight *=
            laws_.miss(member.object, *steps_[t].sensor, steps_[t].sight, steps_[t].detections);
    }
    predict(t + 1, 0, std::move(world));
  }

  void prepare(const Undetected& undetected) {
    belief_.undetected = undetected.expected();
    const int d = knowledge_.dims;
    for (std::size_t t = 0; t < steps_.size(); ++t) {
      belief_.origins.emplace_back(steps_[t].detections.size());
      for (std::size_t i = 0; i < steps_[t].detections.size(); ++i) {
        EnumeratedObject& object = belief_.objects[{t, i}];
        object.mean = Eigen::VectorXd::Zero(d);
        object.covariance = Eigen::MatrixXd::Zero(d, d);
        object.classes.resize(knowledge_.classes.size(), 0);
        for (const ObjectClass& c : knowledge_.classes)
          object.models.emplace_back(c.models.size(), 0);
      }
    }
  }

  /// Adds a complete world to the sums that normalise() divides. Covariances and variances hold
  /// second moments until then.
  void record(const World& world) {
    ++belief_.worlds;
    const double w = world.weight;
    belief_.evidence += w;
    for (std::size_t t = 0; t < world.origins.size(); ++t) {
      for (std::size_t d = 0; d < world.origins[t].size(); ++d) {
        Origin& origin = belief_.origins[t][d];
        const auto& from = world.origins[t][d];
        if (!from)
          origin.p_clutter += w;
        else if (*from == ObjectKey{t, d})
          origin.p_new += w;
        else
          origin.objects[*from] += w;
      }
    }
    for (const World::Member& member : world.members) {
      if (!member.exists) continue;
      const Object& o = member.object;
      double real = 0;  // of w, those in which it is no phantom
      for (int c = 0; c < o.classes.size(); ++c)
        if (!knowledge_.classes[c].phantom) real += w * o.classes(c);
      EnumeratedObject& sum = belief_.objects[member.key];
      const Moments position = laws_.position(o);
      sum.p_exists += real;
      sum.mean += real * position.mean;
      sum.covariance += real * (position.covariance + position.mean * position.mean.transpose());
      for (std::size_t c = 0; c < sum.classes.size(); ++c)
        if (!knowledge_.classes[c].phantom) sum.classes[c] += w * o.classes(c);
      for (std::size_t i = 0; i < o.models.size(); ++i)
        sum.models[o.object_class][i] += real * o.models[i].weight;
      for (const auto& [a, belief] : o.symbols) {
        EnumeratedObject::Symbols& symbols = sum.symbols[a];
        symbols.p_held += real;
        symbols.belief.resize(belief.size(), 0);
        for (std::size_t s = 0; s < symbols.belief.size(); ++s)
          symbols.belief[s] += real * belief(s);
      }
      for (const auto& [a, scalar] : o.scalars) {
        EnumeratedObject::Scalar& moments_of = sum.scalars[a];
        moments_of.p_held += real;
        moments_of.mean += real * scalar.mean;
        moments_of.variance += real * (scalar.variance + scalar.mean * scalar.mean);
      }
    }
  }

  void normalise() {
    for (auto& frame : belief_.origins) {
      for (Origin& origin : frame) {
        origin.p_new /= belief_.evidence;
        origin.p_clutter /= belief_.evidence;
        for (auto& [key, p] : origin.objects) p /= belief_.evidence;
      }
    }
    for (auto& [key, o] : belief_.objects) {
      const double w = o.p_exists;
      if (w == 0) continue;
      o.p_exists /= belief_.evidence;
      o.mean /= w;
      o.covariance = (o.covariance / w - o.mean * o.mean.transpose()).eval();
      for (double& p : o.classes) p /= w;
      for (auto& models : o.models)
        for (double& p : models) p /= w;
      for (auto& [a, symbols] : o.symbols) {
        for (double& p : symbols.belief) p /= symbols.p_held;
        symbols.p_held /= w;
      }
      for (auto& [a, scalar] : o.scalars) {
        scalar.mean /= scalar.p_held;
        scalar.variance = scalar.variance / scalar.p_held - scalar.mean * scalar.mean;
        scalar.p_held /= w;
      }
    }
  }

  const Knowledge& knowledge_;
  Laws laws_;
  std::vector<Step> steps_;
  EnumeratedBelief belief_;
};

}  // namespace

std::string reference(const ObjectKey& key) {
  return "@" + std::to_string(key.frame) + "." + std::to_string(key.detection);
}

std::optional<ObjectKey> parse_reference(const std::string& text) {
  const std::size_t dot = text.find('.');
  if (text.empty() || text[0] != '@' || dot == std::string::npos) return std::nullopt;
  return ObjectKey{std::stoul(text.substr(1, dot - 1)), std::stoul(text.substr(dot + 1))};
}

EnumeratedBelief enumerate(const Knowledge& knowledge, const std::vector<Frame>& frames) {
  return Enumeration(knowledge, frames).take();
}

}  // namespace anchord::enumeration
