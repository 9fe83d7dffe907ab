#pragma once

#include <algorithm>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "anchoring/belief.h"
#include "anchoring/map_event.h"
#include "anchoring/map_frame.h"
#include "anchoring/visibility.h"
#include "core/frame.h"
#include "core/result.h"

namespace anchord {

/// What must be kept of a world so that another one goes on from there as it would.
struct WorldState {
  /// A frame or event before which a late one may still have its place.
  struct Step {
    std::int64_t number = 0;  ///< among all that the world has taken, from 1
    Utime utime = 0;          ///< by which it is in order
  };
  std::shared_ptr<const Belief>
      before;                ///< the first of these steps, or after all if there is none
  std::vector<Step> recent;  ///< in order
  std::map<std::pair<std::string, std::string>, Utime> newest;  ///< by robot and sensor
  std::uint64_t late_frames = 0;
  std::int64_t taken = 0;
  /// When the configuration changed: what came before was believed under another one and is not
  /// folded again. 0: it never did.
  Utime floor = 0;
};

/// A frame or event that has been accepted once.
struct Accepted {
  std::variant<Frame, Event> what;
  std::optional<std::uint64_t> work = std::nullopt;  ///< bound on what folding a frame may take
};

/// The engine: folds frames and events into a belief. Given the same knowledge and the same ones
/// in the same order it makes the same belief, to the bit. Reads no clock. Not thread-safe; a
/// Belief that it has handed out may be read by any thread. Copying one is cheap: copies share what
/// they hold.
class World {
 public:
  explicit World(Knowledge knowledge);
  /// The same, of knowledge that is prepared already.
  explicit World(std::shared_ptr<const Background> background);

  const std::shared_ptr<const Background>& background() const { return background_; }

  /// Takes a frame. A frame that lies behind the newest one, by at most `world.max_lateness`, is
  /// put in its place: the belief is the one that folding in the order (utime, acceptance) gives.
  /// Refuses what place_in_map() does; kConflict: frames of one sensor out of time order, or one
  /// that is too late, or lies before the floor(). A refused frame changes nothing.
  ///
  /// `work` bounds what folding it may take (see Effort), now and whenever a late frame makes it
  /// be folded again. One that is reached leaves out the least probable hypotheses.
  Status apply(const Frame& frame, std::optional<std::uint64_t> work = std::nullopt);

  /// Takes an event. It is put in its place among frames and events, as a late frame is, and takes
  /// effect at the time of the newest frame before it: the belief's utime does not move. One that
  /// is ahead of the newest frame by more than `world.max_lateness` comes from another clock, and
  /// stands behind all that was accepted before it; one that lies before the floor() takes effect
  /// there. Refuses what place_in_map() does, and
  /// check_against() the belief in its place; kConflict: one that is too late. A refused event
  /// changes nothing. Gives the event's number, which an undo names.
  Result<std::int64_t> apply(const Event& event);

  /// What is taken next has this number, where some before it were left out; numbers only rise.
  void count_from(std::int64_t number) { taken_ = std::max(taken_, number - 1); }

  /// The checks of apply() alone.
  Result<MapFrame> check(const Frame& frame) const;
  Result<MapEvent> check(const Event& event) const;

  /// Costs next to nothing: it shares the belief.
  WorldState state() const;
  /// Goes on from a state that a world of the same knowledge was in. `recent`: what it took as
  /// WorldState::recent, in that order. Refuses what place_in_map() does.
  Status resume(WorldState state, const std::vector<Accepted>& recent);

  /// The belief after the frames so far.
  const std::shared_ptr<const Belief>& belief() const { return belief_; }

  /// The newest belief that no late frame can change any more.
  const std::shared_ptr<const Belief>& settled() const {
    return recent_.empty() ? belief_ : recent_.front().before;
  }

  /// utime of the newest frame of this frame's sensor, if there is one.
  std::optional<Utime> newest(const Frame& frame) const;

  /// utime of the belief when the configuration changed last, see reconfigured(); 0: it never did.
  Utime floor() const { return floor_; }

  /// How many frames were put in place before a newer one.
  std::uint64_t late_frames() const { return late_frames_; }

 private:
  struct Step {
    Utime utime;
    std::variant<std::shared_ptr<const MapFrame>, std::shared_ptr<const MapEvent>> taken;
    std::shared_ptr<const Belief> before;
    std::int64_t number = 0;
  };
  Status check_lateness(Utime utime) const;
  Utime order_of(const Event& event) const;
  std::size_t place_in_order(Utime utime) const;
  void insert(Step step);
  const Visibility& visibility(const MapFrame& frame);
  void fold_from(std::size_t first);

  std::shared_ptr<const Background> background_;
  std::shared_ptr<const Belief> belief_;
  std::deque<Step> recent_;  ///< the steps of the last max_lateness seconds, in order of utime
  std::map<std::pair<std::string, std::string>, Utime> newest_;  ///< by robot and sensor
  /// Of each robot's sensors, the view that was met last first.
  std::map<std::pair<std::string, std::string>, std::vector<std::shared_ptr<const Visibility>>>
      visibility_;
  std::uint64_t late_frames_ = 0;
  std::int64_t taken_ = 0;  ///< frames and events
  Utime floor_ = 0;
};

}  // namespace anchord
