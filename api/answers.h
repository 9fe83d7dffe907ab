#pragma once

#include <algorithm>
#include <memory>

#include "anchoring/belief.h"
#include "api/belief_json.h"
#include "api/http_message.h"
#include "api/parameters.h"
#include "api/sighting.h"

namespace anchord {

/// What questions are answered from: a belief that does not change while they are.
struct Snapshot {
  std::shared_ptr<const Belief> belief;
  std::shared_ptr<const Background> background;
  Utime ahead = 0;  ///< answer for that time, later than the belief's; 0: for the belief's own

  Utime utime() const { return std::max(ahead, belief->utime); }
};

/// Answers a question about the belief: `/v1/objects`, `/v1/objects/{id}`, `/v1/where`,
/// `/v1/count`, `/v1/hypotheses`. Pure: the same belief gives the same bytes. 404 for an unknown
/// path or object, 400 with the field for a parameter that cannot be.
HttpResponse answer(const HttpTarget& target, const Snapshot& snapshot,
                    const FramesAt& frames_at = {});

/// The single questions. Errors become 4xx answers.
Result<Json> answer_objects(const HttpTarget& target, const Snapshot& snapshot);
/// `frames_at` tells in which frame the object was last seen; none: that is left out.
Result<Json> answer_object(const std::string& id, const HttpTarget& target,
                           const Snapshot& snapshot, const FramesAt& frames_at = {});
Result<Json> answer_where(const HttpTarget& target, const Snapshot& snapshot);
Result<Json> answer_count(const HttpTarget& target, const Snapshot& snapshot);
Result<Json> answer_hypotheses(const HttpTarget& target, const Snapshot& snapshot);

}  // namespace anchord
