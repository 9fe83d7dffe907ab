#include "anchoring/world.h"

#include <algorithm>

#include "anchoring/association.h"

namespace anchord {

World::World(Knowledge knowledge)
    : background_(std::make_shared<const Background>(std::move(knowledge))) {
  Belief empty;
  for (const auto& arrivals : background_->arrivals)
    empty.undetected.emplace_back(background_->tiling, arrivals);
  empty.names.assign(background_->classes(), 0);
  belief_ = std::make_shared<const Belief>(std::move(empty));
}

Result<MapFrame> World::check(const Frame& frame) const {
  auto placed = place_in_map(frame, *background_);
  if (!placed) return placed;
  if (const auto last = newest(frame); last && frame.utime <= *last)
    return Error{ErrorCode::kConflict, "utime",
                 "is not after this sensor's last frame, " + std::to_string(*last)};
  const Utime late = belief_->utime - frame.utime;
  if (late > from_seconds(background_->knowledge.max_lateness))
    return Error{ErrorCode::kConflict, "utime",
                 "lies " + std::to_string(late) +
                     " us behind the newest frame, more than world.max_lateness"};
  return placed;
}

std::optional<Utime> World::newest(const Frame& frame) const {
  const auto it = newest_.find({frame.robot, frame.sensor});
  return it == newest_.end() ? std::nullopt : std::optional(it->second);
}

const Visibility& World::visibility(const MapFrame& frame) {
  auto& kept = visibility_[{frame.robot, frame.sensor_name}];
  if (!kept || kept->view() != frame.view)
    kept = std::make_shared<const Visibility>(frame.view, *background_);
  return *kept;
}

void World::fold_from(std::size_t first) {
  auto before = recent_[first].before;
  for (std::size_t i = first; i < recent_.size(); ++i) {
    recent_[i].before = before;
    auto after = std::make_shared<Belief>(*before);
    fold(*after, *recent_[i].frame, visibility(*recent_[i].frame), *background_);
    before = std::move(after);
  }
  belief_ = std::move(before);
}

Status World::apply(const Frame& frame) {
  auto placed = check(frame);
  if (!placed) return placed.error();
  newest_[{frame.robot, frame.sensor}] = frame.utime;

  auto place = recent_.end();
  while (place != recent_.begin() && std::prev(place)->frame->utime > frame.utime) --place;
  const auto index = static_cast<std::size_t>(place - recent_.begin());
  if (index < recent_.size()) ++late_frames_;
  auto before = index < recent_.size() ? recent_[index].before : belief_;
  recent_.insert(place,
                 Step{std::make_shared<const MapFrame>(std::move(*placed)), std::move(before)});
  fold_from(index);

  const Utime horizon = belief_->utime - from_seconds(background_->knowledge.max_lateness);
  while (recent_.size() > 1 && recent_.front().frame->utime < horizon) recent_.pop_front();
  return Done{};
}

}  // namespace anchord
