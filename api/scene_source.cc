#include "api/scene_source.h"

#include <utility>

#include "api/merge_patch.h"

namespace anchord {

std::shared_ptr<const SceneSource::State> SceneSource::current() {
  std::lock_guard lock(mutex_);
  const std::uint64_t changes = changes_;
  if (newest_ && known_ == changes) return newest_;
  auto state = std::make_shared<State>();
  state->number = newest_ ? newest_->number + 1 : 1;
  const auto [snapshot, parts] = look_();
  state->scene = scene_json(snapshot, parts);
  state->text = state->scene.dump();
  known_ = changes;
  newest_ = std::move(state);
  return newest_;
}

std::string SceneSource::change(const std::shared_ptr<const State>& from,
                                const std::shared_ptr<const State>& to) {
  std::lock_guard lock(mutex_);
  if (from_ == from->number && to_ == to->number) return change_;
  const auto patch = merge_patch(from->scene, to->scene);
  from_ = from->number;
  to_ = to->number;
  return change_ = patch ? patch->dump() : "";
}

}  // namespace anchord
