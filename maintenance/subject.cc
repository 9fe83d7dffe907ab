#include "maintenance/subject.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "maintenance/entropy.h"

namespace anchord {
namespace {

constexpr double kLeastWeight = 1e-6;  // of a component that is looked at by itself
constexpr double kLeastPool = 0.02;    // of `somewhere`: below it, no look finds it there
constexpr double kAlike2 = 1;          // squared Mahalanobis distance of means that are one

Subject::Track track_of(double weight, const Kinematic& state, const BehaviourModel& model,
                        double leak) {
  return {weight, state,           model.psd, model.kind == BehaviourModel::Kind::kConstantVelocity,
          leak,   model.detectable};
}

double distance2(const Kinematic& a, const Kinematic& b, int dims) {
  Eigen::Matrix3d s = a.pp + b.pp;
  if (dims == 2) s(2, 2) = 1;
  const Eigen::Vector3d d = a.position - b.position;
  return d.dot(s.inverse() * d);
}

/// Merges `track` into the nearest one like it, if that is near or there is no more room.
void add(std::vector<Subject::Track>& tracks, const Subject::Track& track, int dims) {
  Subject::Track* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (Subject::Track& other : tracks) {
    if (other.detectable != track.detectable || other.moves != track.moves) continue;
    if (const double d2 = distance2(other.state, track.state, dims); d2 < least) {
      least = d2;
      nearest = &other;
    }
  }
  if (!nearest || (least > kAlike2 && tracks.size() < kMaxTracks)) {
    tracks.push_back(track);
    return;
  }
  nearest->state = merge(nearest->weight, nearest->state, track.weight, track.state);
  nearest->weight += track.weight;
}

/// The cells of a `somewhere` in blocks.
void add_tiles(double weight, const Somewhere& somewhere, std::vector<Subject::Tile>& tiles) {
  const Footprint& f = *somewhere.footprint();
  const int edge = std::max(
      1,
      static_cast<int>(std::ceil(std::sqrt(static_cast<double>(f.cells.size()) / kTilesPerPlace))));
  const int columns = (f.grid.columns + edge - 1) / edge;
  const double z = f.dims == 3 ? (f.region.z_min + f.region.z_max) / 2 : 0;
  std::map<int, Subject::Tile> blocks;
  std::map<int, double> shares;
  for (std::size_t i = 0; i < f.cells.size(); ++i) {
    const int row = f.cells[i] / f.grid.columns, column = f.cells[i] % f.grid.columns;
    const int block = row / edge * columns + column / edge;
    Subject::Tile& tile = blocks[block];
    const Eigen::Vector3d middle =
        (f.grid.corner_min(f.cells[i]) + f.grid.corner_max(f.cells[i])) / 2;
    tile.weight += weight * somewhere.mass_in(static_cast<int>(i));
    tile.center.head<2>() += f.share[i] * middle.head<2>();
    shares[block] += f.share[i];
  }
  for (auto& [block, tile] : blocks) {
    const double share = shares[block];
    tile.center.head<2>() /= share;
    tile.center.z() = z;
    tile.volume = share * f.volume;
    if (tile.weight > 0) tiles.push_back(tile);
  }
}

/// Where a track that leaks goes, and how fast.
struct Loss {
  double rate = 0;     ///< 1/s
  double entropy = 0;  ///< nat
};
Loss loss_of(const ObjectClass& object_class, const Background& background) {
  Loss loss;
  for (const BehaviourModel& model : object_class.models) loss.rate += model.rate;
  for (const BehaviourModel& model : object_class.models) {
    if (model.rate <= 0) continue;
    const double share = model.rate / loss.rate;
    loss.entropy += share * (std::log(background.footprint(model.place)->volume) - std::log(share));
  }
  return loss;
}

/// The mutual information of the class and one report of it through a confusion matrix.
double class_gain(const std::vector<double>& classes,
                  const std::vector<std::vector<double>>& confusion) {
  if (confusion.empty()) return 0;
  std::vector<double> reported(classes.size(), 0.0);
  double noise = 0;
  for (std::size_t c = 0; c < classes.size(); ++c) {
    if (classes[c] < kLeastWeight) continue;
    for (std::size_t z = 0; z < reported.size(); ++z) reported[z] += classes[c] * confusion[c][z];
    noise += classes[c] * discrete_entropy(confusion[c]);
  }
  return std::max(0.0, discrete_entropy(reported) - noise);
}

void add_sensors(Subject& subject, const std::vector<double>& classes, const Knowledge& knowledge) {
  for (const Sensor& sensor : knowledge.sensors) {
    double q = 0, per_m = 0;
    for (std::size_t c = 0; c < classes.size(); ++c) {
      q += classes[c] * sensor.detection_probability[c].near;
      per_m += classes[c] * sensor.detection_probability[c].per_m;
    }
    subject.detection_probability.emplace_back(std::min(q, 1.0), per_m);
    const int a = knowledge.class_attribute;
    subject.class_gain.push_back(
        a < 0 || sensor.confusion.empty() || subject.class_entropy < kLeastWeight
            ? 0.0
            : class_gain(classes, sensor.confusion[static_cast<std::size_t>(a)]));
  }
}

}  // namespace

Eigen::Vector3d Subject::mean() const {
  double most = -1;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Track& track : tracks)
    if (track.weight > most) most = track.weight, mean = track.state.position;
  for (const Tile& tile : tiles)
    if (tile.weight > most && tile.center.allFinite()) most = tile.weight, mean = tile.center;
  return mean;
}

Subject single_subject(std::string id, const Gaussian& position, double psd, double p,
                       int top_class, const Knowledge& knowledge) {
  Subject subject;
  subject.id = std::move(id);
  subject.p = p;
  subject.top_class = top_class;
  subject.found_psd = psd;
  Kinematic state;
  state.position = position.mean;
  state.pp = position.covariance;
  subject.tracks.push_back({1, state, psd, false, 0, true});
  std::vector<double> classes(knowledge.classes.size(), 0.0);
  classes[static_cast<std::size_t>(top_class)] = 1;
  add_sensors(subject, classes, knowledge);
  return subject;
}

Subject subject_of(const ObjectBelief& object, const Background& background) {
  const Knowledge& knowledge = background.knowledge;
  Subject subject;
  subject.id = object.anchor->id();
  subject.p = std::min(object.p, 1.0);
  const std::vector<double> classes = object.classes(background);
  subject.top_class = object.shown().top_class();
  subject.class_entropy = class_entropy(object, background);
  subject.attribute_entropy = attribute_entropy(object);
  add_sensors(subject, classes, knowledge);

  const int model_class = object.shown().model_class;
  subject.lost_entropy = loss_of(background.object_class(model_class), background).entropy;
  const auto& dynamics = background.dynamics[static_cast<std::size_t>(model_class)];
  const BehaviourModel& found = background.object_class(model_class)
                                    .models[static_cast<std::size_t>(dynamics.first_detectable)];
  subject.found_psd = found.psd;
  subject.found_moves = found.kind == BehaviourModel::Kind::kConstantVelocity;
  subject.initial_velocity_variance = found.initial_velocity_variance;

  std::vector<Subject::Track> all;
  double pool = 0, pool_bound = 0;  // sum of w (H - ln w) over what is not looked at by itself
  std::vector<Subject::Tile> tiles;
  std::vector<std::pair<double, const Somewhere*>> places;
  for (const auto& version : object.versions) {
    const ObjectClass& owner = background.object_class(version.leaf.model_class);
    const double leak = loss_of(owner, background).rate;
    for (std::size_t m = 0; m < version.leaf.models.size(); ++m) {
      const ModelState& model = version.leaf.models[m];
      const double weight = version.weight(object.p) * model.weight;
      if (weight <= 0) continue;
      if (const auto* kinematic = std::get_if<Kinematic>(&model.density)) {
        all.push_back(track_of(weight, *kinematic, owner.models[m], leak));
      } else {
        places.emplace_back(weight, &std::get<Somewhere>(model.density));
        pool += weight;
      }
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.weight > b.weight; });
  for (const Subject::Track& track : all)
    if (track.weight >= kLeastWeight || subject.tracks.empty())
      add(subject.tracks, track, background.dims);
  if (pool >= kLeastPool) {
    for (const auto& [weight, somewhere] : places) add_tiles(weight, *somewhere, subject.tiles);
  } else if (pool > 0) {
    // One tile out of sight, of the entropy that the places have together.
    for (const auto& [weight, somewhere] : places)
      pool_bound += weight * (somewhere->entropy() - std::log(weight));
    constexpr double kNowhere = std::numeric_limits<double>::infinity();
    subject.tiles.push_back(
        {pool, Eigen::Vector3d::Constant(kNowhere), std::exp(pool_bound / pool + std::log(pool))});
  }
  double sum = 0;
  for (const auto& track : subject.tracks) sum += track.weight;
  for (const auto& tile : subject.tiles) sum += tile.weight;
  for (auto& track : subject.tracks) track.weight /= sum;
  for (auto& tile : subject.tiles) tile.weight /= sum;
  return subject;
}

std::vector<Subject> read_subjects(const Belief& belief, Utime at, double min_p,
                                   const Background& background) {
  std::vector<Subject> subjects;
  for (const ObjectBelief& object : read_objects(belief, at, min_p, background))
    subjects.push_back(subject_of(object, background));
  return subjects;
}

}  // namespace anchord
