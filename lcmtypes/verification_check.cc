#include <anchord/event_t.hpp>
#include <anchord/image_t.hpp>
#include <anchord/robot_pose_t.hpp>
#include <anchord/verify_result_t.hpp>
#include <anchord/verify_task_t.hpp>
#include <anchord/verify_trigger_t.hpp>

#include "core/event.h"
#include "core/verification.h"
#include "lcmtypes/field.h"
#include "lcmtypes/frame_walk.h"
#include "lcmtypes/names.h"
#include "lcmtypes/walk.h"
#include "lcmtypes/wire_check.h"

namespace anchord {
namespace {

constexpr std::size_t kLeastRegion = 1 + (1 + 3 + 9 + 1) * kNumberBytes + 4 + 2 * kNumberBytes;

bool walk_region(Walk& walk, const Field& region) {
  int kind = 0;
  if (!walk.enumerator(region.member("kind"), region_t::ELLIPSOID, region_t::PRISM, kind) ||
      !walk.numbers(region.member("p"), 1) || !walk.numbers(region.member("center"), 3) ||
      !walk.numbers(region.member("covariance"), 9) || !walk.numbers(region.member("radius"), 1)) {
    return false;
  }
  const std::size_t most_points = kind == region_t::PRISM ? kMaxPolygonPoints : 0;
  std::size_t points = 0;
  return walk.count(region.member("num_points"), most_points, 2 * kNumberBytes, points) &&
         walk.numbers(region.member("polygon"), 2 * points) && walk.numbers(region.member("z"), 2);
}

bool walk_regions(Walk& walk, const Field& message) {
  std::size_t regions = 0;
  if (!walk.count(message.member("num_regions"), kMaxRegions, kLeastRegion, regions)) return false;
  const Field list = message.member("regions");
  for (std::size_t i = 0; i < regions; ++i) {
    if (!walk_region(walk, list.element(i))) return false;
  }
  return true;
}

bool walk_event(Walk& walk, const Field& event) {
  int kind = 0;
  return walk.numbers(event.member("utime"), 1) && walk.numbers(event.member("seq"), 1) &&
         walk.enumerator(event.member("kind"), event_t::MISSING, event_t::UNDONE, kind) &&
         walk.text(event.member("robot")) && walk.text(event.member("object")) &&
         walk.text(event.member("other")) && walk.text(event.member("place")) &&
         walk.text(event.member("sensor")) && walk.flag(event.member("has_position")) &&
         walk.numbers(event.member("position"), 3) && walk.flag(event.member("has_covariance")) &&
         walk.numbers(event.member("covariance"), 9) && walk_regions(walk, event) &&
         walk.numbers(event.member("undone"), 1);
}

bool walk_trigger(Walk& walk, const Field& trigger) {
  int command = 0;
  return walk.numbers(trigger.member("utime"), 1) &&
         walk.enumerator(trigger.member("command"), verify_trigger_t::TRIGGER,
                         verify_trigger_t::CANCEL, command) &&
         walk.numbers(trigger.member("task"), 1) && walk.text(trigger.member("object")) &&
         walk.text(trigger.member("description"), kMaxTargetBytes) &&
         walk.text(trigger.member("action")) && walk.text(trigger.member("robot")) &&
         walk.text(trigger.member("sensor")) && walk.numbers(trigger.member("timeout_s"), 1) &&
         walk.flag(trigger.member("alone")) && walk.numbers(trigger.member("tag"), 1);
}

bool walk_task(Walk& walk, const Field& task) {
  int state = 0;
  std::size_t tags = 0;
  const Field viewpoint = task.member("viewpoint");
  return walk.numbers(task.member("utime"), 1) && walk.numbers(task.member("id"), 1) &&
         walk.enumerator(task.member("state"), verify_task_t::QUEUED, verify_task_t::CANCELLED,
                         state) &&
         walk.flag(task.member("triggered")) &&
         walk.count(task.member("num_tags"), kMaxTags, kNumberBytes, tags) &&
         walk.numbers(task.member("tags"), tags) && walk.text(task.member("action")) &&
         walk.text(task.member("object")) && walk.text(task.member("object_class")) &&
         walk.text(task.member("robot")) && walk.text(task.member("sensor")) &&
         walk.text(task.member("wanted_sensor")) && walk.numbers(task.member("created"), 1) &&
         walk.numbers(task.member("issued"), 1) && walk.numbers(task.member("ended"), 1) &&
         walk.numbers(task.member("deadline"), 1) && walk.flag(task.member("has_viewpoint")) &&
         walk_pose(walk, viewpoint) && walk_regions(walk, task) &&
         walk_attributes(walk, task.member("num_appearance"), task.member("appearance")) &&
         walk.numbers(task.member("extent"), 3) && walk.numbers(task.member("gain_nat"), 1) &&
         walk.numbers(task.member("cost"), 1) && walk.numbers(task.member("utility"), 1) &&
         walk.text(task.member("reason"), kMaxReasonBytes);
}

bool walk_result(Walk& walk, const Field& result) {
  int outcome = 0;
  bool has_frame = false;
  return walk.numbers(result.member("task"), 1) &&
         walk.enumerator(result.member("outcome"), verify_result_t::FOUND,
                         verify_result_t::OCCLUDED, outcome) &&
         walk.numbers(result.member("utime"), 1) && walk.text(result.member("robot")) &&
         walk.text(result.member("sensor")) && walk.flag(result.member("has_frame"), has_frame) &&
         walk_frame(walk, result.member("frame"), has_frame);
}

bool walk_robot_pose(Walk& walk, const Field& message) {
  return walk.numbers(message.member("utime"), 1) && walk.text(message.member("robot")) &&
         walk_pose(walk, message.member("pose"));
}

/// Whether `bytes` are what an image of `width` * `height` pixels takes. A JPEG takes what it
/// takes.
bool walk_size(Walk& walk, const Field& num_bytes, int format, std::size_t width,
               std::size_t height, std::size_t bytes) {
  if (format == image_t::JPEG) return bytes > 0 || walk.refuse(num_bytes, "must not be 0");
  const std::size_t each = format == image_t::BGR8 ? 3 : format == image_t::DEPTH16_MM ? 2 : 1;
  return bytes == width * height * each ||
         walk.refuse(num_bytes, "must be width * height * " + std::to_string(each));
}

bool walk_side(Walk& walk, const Field& side, std::size_t& pixels) {
  return walk.whole(side, kMaxImageSide, pixels) &&
         (pixels > 0 || walk.refuse(side, "must not be 0"));
}

bool walk_image(Walk& walk, const Field& image) {
  int format = 0;
  std::size_t width = 0, height = 0, bytes = 0;
  const Field num_bytes = image.member("num_bytes");
  return walk.numbers(image.member("utime"), 1) && walk.numbers(image.member("seq"), 1) &&
         walk.text(image.member("robot")) && walk.name(image.member("sensor")) &&
         walk.flag(image.member("has_pose")) && walk_pose(walk, image.member("pose")) &&
         walk_side(walk, image.member("width"), width) &&
         walk_side(walk, image.member("height"), height) &&
         walk.enumerator(image.member("format"), image_t::GRAY8, image_t::DEPTH16_MM, format) &&
         walk.count(num_bytes, kMaxImageMessageBytes, 1, bytes) &&
         walk_size(walk, num_bytes, format, width, height, bytes) &&
         walk.skip(image.member("data"), bytes);
}

template <typename Message>
Status check(Walk walk, bool (*walk_message)(Walk&, const Field&)) {
  walk.fingerprint(Message::getHash()) && walk_message(walk, Field()) && walk.end();
  return walk.outcome();
}

}  // namespace

Status check_event(std::span<const std::uint8_t> bytes) {
  return check<event_t>(Walk(bytes), walk_event);
}

Status check_trigger(std::span<const std::uint8_t> bytes) {
  return check<verify_trigger_t>(Walk(bytes), walk_trigger);
}

Status check_task(std::span<const std::uint8_t> bytes) {
  return check<verify_task_t>(Walk(bytes), walk_task);
}

Status check_result(std::span<const std::uint8_t> bytes) {
  return check<verify_result_t>(Walk(bytes), walk_result);
}

Status check_robot_pose(std::span<const std::uint8_t> bytes) {
  return check<robot_pose_t>(Walk(bytes), walk_robot_pose);
}

Status check_image(std::span<const std::uint8_t> bytes) {
  return check<image_t>(Walk(bytes, kMaxImageMessageBytes), walk_image);
}

}  // namespace anchord
