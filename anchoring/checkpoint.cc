#include "anchoring/checkpoint.h"

#define CEREAL_FUTURE_EXPERIMENTAL  // archives that carry the Background along
#include <cereal/archives/adapters.hpp>
#include <cereal/archives/binary.hpp>
#include <cereal/types/array.hpp>
#include <cereal/types/map.hpp>
#include <cereal/types/memory.hpp>
#include <cereal/types/optional.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/utility.hpp>
#include <cereal/types/vector.hpp>
#include <exception>
#include <sstream>
#include <string>

namespace cereal {

template <typename Archive, typename Scalar, int rows, int columns>
void serialize(Archive& archive, Eigen::Matrix<Scalar, rows, columns>& matrix) {
  for (Eigen::Index i = 0; i < matrix.size(); ++i) archive(matrix.data()[i]);
}

template <typename Archive, typename T, std::size_t n, typename A>
void save(Archive& archive, const boost::container::small_vector<T, n, A>& values) {
  archive(make_size_tag(static_cast<size_type>(values.size())));
  for (const T& value : values) archive(value);
}

template <typename Archive, typename T, std::size_t n, typename A>
void load(Archive& archive, boost::container::small_vector<T, n, A>& values) {
  size_type size = 0;
  archive(make_size_tag(size));
  values.resize(static_cast<std::size_t>(size));
  for (T& value : values) archive(value);
}

}  // namespace cereal

namespace anchord {

/// A checkpoint begins with kMagic plus the version of its format. Version N holds what version
/// N - 1 did, and where a serialize() below says since(archive, N, ...) that, too: to add
/// something, raise kVersion and say so. What an older checkpoint does not hold stays as it is made
/// empty.
///
/// 1: as of 0.1.0's first beliefs. 2: a configuration may change (floor, and since when a class's
/// undetected intensity counts). 3: what is somewhere is held by blocks of cells, instead of by
/// cell.
constexpr std::uint32_t kMagic = 0x61630000, kVersion = 3;

/// What an archive of a checkpoint carries along.
struct CheckpointContext {
  const Background& background;
  std::uint32_t version = kVersion;  ///< of the format
};

/// What the engine keeps, member by member. One function for both directions, so that they cannot
/// part. Found by argument-dependent lookup, so not in an anonymous namespace.
template <typename Archive>
const CheckpointContext& context_of(Archive& archive) {
  return cereal::get_user_data<const CheckpointContext>(archive);
}

/// Members that checkpoints hold from that version on.
template <typename Archive, typename... Members>
void since(Archive& archive, std::uint32_t version, Members&... members) {
  if (context_of(archive).version >= version) archive(members...);
}

template <typename Archive>
void serialize(Archive& archive, Kinematic& k) {
  archive(k.position, k.velocity, k.pp, k.pv, k.vv);
}

template <typename Archive>
void serialize(Archive& archive, MovingIntensity::Component& c) {
  archive(c.weight, c.density);
}

template <typename Archive>
void serialize(Archive& archive, AttributeBelief& b) {
  archive(b.attribute, b.symbols, b.mean, b.variance);
}

/// A place is written by its index: footprints are the Background's.
template <typename Archive>
void save(Archive& archive, const ModelState& state) {
  archive(state.weight, state.seen);
  const auto* somewhere = std::get_if<Somewhere>(&state.density);
  archive(somewhere != nullptr);
  if (!somewhere) return archive(std::get<Kinematic>(state.density)), void();
  const Background& background = context_of(archive).background;
  archive(background.place_of(*somewhere->footprint()), *somewhere);
}

template <typename Archive>
void load(Archive& archive, ModelState& state) {
  archive(state.weight, state.seen);
  bool in_place = false;
  archive(in_place);
  if (!in_place) return archive(state.density.emplace<Kinematic>()), void();
  int place = 0;
  archive(place);
  const Background& background = context_of(archive).background;
  auto& somewhere = state.density.emplace<Somewhere>(background.footprint(place));
  if (context_of(archive).version >= 3)
    archive(somewhere);
  else
    somewhere.load_by_cell(archive);
  if (!somewhere.fits()) throw cereal::Exception("heights that are not those of the place");
}

template <typename Archive>
void serialize(Archive& archive, Leaf& l) {
  archive(l.existence, l.classes, l.model_class, l.models, l.attributes, l.yaw, l.scores, l.held,
          l.utime, l.last_seen, l.recent);
}

template <typename Archive>
void serialize(Archive& archive, Anchor& a) {
  archive(a.birth, a.name, a.alias, a.holder);
}

template <typename Archive>
void serialize(Archive& archive, AnchorTree& tree) {
  archive(tree.anchor, tree.leaves, tree.shown);
}

template <typename Archive>
void serialize(Archive& archive, Hypothesis& h) {
  archive(h.log_weight, h.leaf);
}

template <typename Archive>
void serialize(Archive& archive, Cluster& cluster) {
  archive(cluster.anchors, cluster.hypotheses, cluster.leading);
}

template <typename Archive>
void serialize(Archive& archive, Reach::Axis& axis) {
  archive(axis.low, axis.high, axis.slowest, axis.fastest, axis.variance);
}

template <typename Archive>
void serialize(Archive& archive, Reach& reach) {
  archive(reach.from, reach.axis, reach.places, reach.due);
}

template <typename Archive>
void serialize(Archive& archive, SetAside& aside) {
  archive(aside.number, aside.anchors, aside.birth, aside.alias);
}

template <typename Archive>
void serialize(Archive& archive, Effort& effort) {
  archive(effort.work, effort.dropped, effort.cut);
}

/// `undetected` and `moving` are those of an empty belief when they are read.
template <typename Archive>
void serialize(Archive& archive, Belief& b) {
  archive(b.utime, b.start, b.frames, b.clusters, b.births, b.names, b.set_aside, b.log_evidence,
          b.effort, b.dropped, b.cut_frames);
  for (UndetectedIntensity& undetected : b.undetected) archive(undetected);
  for (MovingIntensity& moving : b.moving) archive(moving);
  if (context_of(archive).version >= 2)
    for (UndetectedIntensity& undetected : b.undetected) undetected.serialize_since(archive);
}

template <typename Archive>
void serialize(Archive& archive, WorldState::Step& step) {
  archive(step.number, step.utime);
}

template <typename Archive>
void serialize(Archive& archive, WorldState& state) {
  archive(state.recent, state.newest, state.late_frames, state.taken);
  since(archive, 2, state.floor);
}

namespace {

/// What must be the same for indices to mean the same.
std::string shape_of(const Background& background) {
  const Knowledge& known = background.knowledge;
  std::string shape = std::to_string(known.dims) + " " + std::to_string(background.grid.columns) +
                      " " + std::to_string(background.grid.rows);
  for (const Place& place : known.places) shape += " " + place.name;
  for (const Attribute& attribute : known.attributes) {
    shape += " " + attribute.name;
    for (const std::string& symbol : attribute.symbols) shape += " " + symbol;
  }
  for (const ObjectClass& c : known.classes)
    shape += " " + c.name + " " + std::to_string(c.models.size());
  return shape;
}

}  // namespace

std::vector<std::uint8_t> write_checkpoint(const WorldState& state, const Background& background) {
  std::ostringstream out(std::ios::binary);
  {
    const CheckpointContext context{background};
    cereal::UserDataAdapter<const CheckpointContext, cereal::BinaryOutputArchive> archive(context,
                                                                                          out);
    archive(kMagic + kVersion, shape_of(background), state, *state.before);
  }
  const std::string bytes = std::move(out).str();
  return {bytes.begin(), bytes.end()};
}

Result<WorldState> read_checkpoint(const std::vector<std::uint8_t>& bytes, const World& empty) {
  const Background& background = *empty.background();
  std::istringstream in(std::string(bytes.begin(), bytes.end()), std::ios::binary);
  try {
    CheckpointContext context{background};
    cereal::UserDataAdapter<const CheckpointContext, cereal::BinaryInputArchive> archive(context,
                                                                                         in);
    std::uint32_t format = 0;
    archive(format);
    context.version = format - kMagic;  // of what is no checkpoint, far too much
    if (context.version == 0 || context.version > kVersion)
      return invalid("checkpoint", context.version >> 16 ? "is of another format"
                                                         : "is of a newer program's format");
    std::string shape;
    archive(shape);
    if (shape != shape_of(background)) return invalid("checkpoint", "is of another configuration");
    WorldState state;
    auto before = std::make_shared<Belief>(*empty.belief());
    archive(state, *before);
    state.before = std::move(before);
    return state;
  } catch (const std::exception& error) {  // cereal has no other way to say that it ends too early
    return invalid("checkpoint", std::string("cannot be read: ") + error.what());
  }
}

}  // namespace anchord
