#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "api/scene.h"

namespace anchord {

/// The scene that the stream shows, worked out once for all who watch, and only while somebody
/// does. Safe from any thread.
class SceneSource {
 public:
  /// One instant; does not change.
  struct State {
    std::uint64_t number = 0;
    nlohmann::json scene;  ///< see scene_json()
    std::string text;      ///< the same
  };

  /// What there is to be shown; called from any thread, one at a time.
  using Look = std::function<std::pair<Snapshot, SceneParts>()>;

  explicit SceneSource(Look look) : look_(std::move(look)) {}

  /// The belief, a task or a robot is not as it was.
  void changed() { ++changes_; }

  /// The newest state.
  std::shared_ptr<const State> current();

  /// What turns one state into another, as a JSON merge patch; empty if nothing does. The latest is
  /// kept: those who watch at one rate ask for the same.
  std::string change(const std::shared_ptr<const State>& from,
                     const std::shared_ptr<const State>& to);

 private:
  const Look look_;
  std::atomic<std::uint64_t> changes_{1};

  std::mutex mutex_;
  std::uint64_t known_ = 0;  ///< changes that the newest state has; guarded, as all below
  std::shared_ptr<const State> newest_;
  std::uint64_t from_ = 0, to_ = 0;
  std::string change_;  ///< between those two
};

}  // namespace anchord
