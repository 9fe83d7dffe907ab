#include "anchoring/world.h"

#include <algorithm>

#include "anchoring/association.h"

namespace anchord {

World::World(Knowledge knowledge)
    : World(std::make_shared<const Background>(std::move(knowledge))) {}

World::World(std::shared_ptr<const Background> background) : background_(std::move(background)) {
  Belief empty;
  for (const auto& arrivals : background_->arrivals)
    empty.undetected.emplace_back(background_->tiling, arrivals);
  for (const auto& arrivals : background_->moving_arrivals) empty.moving.emplace_back(arrivals);
  empty.names.assign(background_->classes(), 0);
  belief_ = std::make_shared<const Belief>(std::move(empty));
}

Result<MapFrame> World::check(const Frame& frame) const {
  auto placed = place_in_map(frame, *background_);
  if (!placed) return placed;
  if (const auto last = newest(frame); last && frame.utime <= *last)
    return Error{ErrorCode::kConflict, "utime",
                 "is not after this sensor's last frame, " + std::to_string(*last)};
  if (Status in_time = check_lateness(frame.utime); !in_time) return in_time.error();
  if (frame.utime < floor_)
    return Error{
        ErrorCode::kConflict, "utime",
        "lies before the change of the configuration at " + std::to_string(floor_) + " us"};
  return placed;
}

Result<MapEvent> World::check(const Event& event) const {
  auto placed = place_in_map(event, *background_);
  if (!placed) return placed;
  if (Status in_time = check_lateness(event.utime); !in_time) return in_time.error();
  const std::size_t place = place_in_order(order_of(event));
  const Belief& met = place < recent_.size() ? *recent_[place].before : *belief_;
  if (Status fits = check_against(*placed, met); !fits) return fits.error();
  return placed;
}

Status World::check_lateness(Utime utime) const {
  const Utime late = belief_->utime - utime;
  if (late <= from_seconds(background_->knowledge.max_lateness)) return Done{};
  return Error{
      ErrorCode::kConflict, "utime",
      "lies " + std::to_string(late) + " us behind the newest frame, more than world.max_lateness"};
}

std::optional<Utime> World::newest(const Frame& frame) const {
  const auto it = newest_.find({frame.robot, frame.sensor});
  return it == newest_.end() ? std::nullopt : std::optional(it->second);
}

/// Those of each sensor's last few views: cameras pan to and fro, and what a late frame makes be
/// folded anew has the views that it had.
const Visibility& World::visibility(const MapFrame& frame) {
  constexpr std::size_t kKept = 6;
  auto& kept = visibility_[{frame.robot, frame.sensor_name}];
  std::size_t known = 0;
  while (known < kept.size() && !kept[known]->same_for(frame)) ++known;
  if (known == kept.size()) {
    if (kept.size() < kKept) kept.emplace_back();
    known = kept.size() - 1;
    kept[known] = std::make_shared<const Visibility>(frame, *background_);
  }
  const auto at = kept.begin() + static_cast<std::ptrdiff_t>(known);
  std::rotate(kept.begin(), at, at + 1);
  return *kept.front();
}

void World::fold_from(std::size_t first) {
  auto before = recent_[first].before;
  for (std::size_t i = first; i < recent_.size(); ++i) {
    recent_[i].before = before;
    auto after = std::make_shared<Belief>(*before);
    if (const auto* frame = std::get_if<std::shared_ptr<const MapFrame>>(&recent_[i].taken))
      fold(*after, **frame, visibility(**frame), *background_);
    else
      fold(*after, *std::get<std::shared_ptr<const MapEvent>>(recent_[i].taken), *background_);
    before = std::move(after);
  }
  belief_ = std::move(before);
}

/// The utime by which an event is put in order.
Utime World::order_of(const Event& event) const {
  const Utime newest = belief_->utime;
  if (event.utime - newest <= from_seconds(background_->knowledge.max_lateness)) return event.utime;
  return recent_.empty() ? newest : std::max(newest, recent_.back().utime);
}

/// Where a step of that time stands: behind all of its time or earlier.
std::size_t World::place_in_order(Utime utime) const {
  auto place = recent_.end();
  while (place != recent_.begin() && std::prev(place)->utime > utime) --place;
  return static_cast<std::size_t>(place - recent_.begin());
}

void World::insert(Step step) {
  const std::size_t index = place_in_order(step.utime);
  step.before = index < recent_.size() ? recent_[index].before : belief_;
  recent_.insert(recent_.begin() + static_cast<std::ptrdiff_t>(index), std::move(step));
  recent_[index].number = ++taken_;
  fold_from(index);
  const Utime horizon = belief_->utime - from_seconds(background_->knowledge.max_lateness);
  while (recent_.size() > 1 && recent_.front().utime < horizon) recent_.pop_front();
}

WorldState World::state() const {
  WorldState state{belief_, {}, newest_, late_frames_, taken_, floor_};
  if (!recent_.empty()) state.before = recent_.front().before;
  for (const Step& step : recent_) state.recent.push_back({step.number, step.utime});
  return state;
}

Status World::resume(WorldState state, const std::vector<Accepted>& recent) {
  std::deque<Step> steps;
  for (std::size_t i = 0; i < recent.size(); ++i) {
    const auto& [number, utime] = state.recent[i];
    Step step{utime, {}, state.before, number};
    if (const auto* frame = std::get_if<Frame>(&recent[i].what)) {
      auto placed = place_in_map(*frame, *background_);
      if (!placed) return placed.error();
      placed->work = recent[i].work;
      step.taken = std::make_shared<const MapFrame>(*std::move(placed));
    } else {
      auto placed = place_in_map(std::get<Event>(recent[i].what), *background_);
      if (!placed) return placed.error();
      placed->number = number;
      step.taken = std::make_shared<const MapEvent>(*std::move(placed));
    }
    steps.push_back(std::move(step));
  }
  belief_ = std::move(state.before);
  recent_ = std::move(steps);
  newest_ = std::move(state.newest);
  late_frames_ = state.late_frames;
  taken_ = state.taken;
  floor_ = state.floor;
  if (!recent_.empty()) fold_from(0);
  return Done{};
}

Status World::apply(const Frame& frame, std::optional<std::uint64_t> work) {
  auto placed = check(frame);
  if (!placed) return placed.error();
  placed->work = work;
  newest_[{frame.robot, frame.sensor}] = frame.utime;
  if (frame.utime < belief_->utime) ++late_frames_;
  insert({frame.utime, std::make_shared<const MapFrame>(*std::move(placed)), nullptr});
  return Done{};
}

Result<std::int64_t> World::apply(const Event& event) {
  auto placed = check(event);
  if (!placed) return placed.error();
  placed->number = taken_ + 1;
  insert({order_of(event), std::make_shared<const MapEvent>(*std::move(placed)), nullptr});
  return taken_;
}

}  // namespace anchord
