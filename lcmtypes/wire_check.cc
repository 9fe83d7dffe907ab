#include "lcmtypes/wire_check.h"

#include <anchord/frame_t.hpp>
#include <anchord/query_t.hpp>

#include "lcmtypes/field.h"
#include "lcmtypes/frame_walk.h"
#include "lcmtypes/names.h"
#include "lcmtypes/walk.h"

namespace anchord {
namespace {

bool walk_query(Walk& walk, const Field& query) {
  return walk.numbers(query.member("id"), 1) && walk.text(query.member("target"), kMaxTargetBytes);
}

}  // namespace

Status check_frame(std::span<const std::uint8_t> bytes) {
  Walk walk(bytes);
  walk.fingerprint(frame_t::getHash()) && walk_frame(walk, Field()) && walk.end();
  return walk.outcome();
}

Status check_query(std::span<const std::uint8_t> bytes) {
  Walk walk(bytes);
  walk.fingerprint(query_t::getHash()) && walk_query(walk, Field()) && walk.end();
  return walk.outcome();
}

}  // namespace anchord
