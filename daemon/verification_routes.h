#pragma once

#include "api/http_server.h"
#include "daemon/journal.h"
#include "daemon/robots.h"
#include "daemon/verifications.h"

namespace anchord {

/// An event is told where the robot is, if that is known and it does not say where itself: what is
/// grasped is there, and so is what is put down without a word of where.
Event with_robot(Event event, Robots& robots);

/// POST /v1/events: 200 with {"accepted": 1, "number": N} once it is durable and folded.
void receive_event(const HttpRequest& request, const HttpReply& reply, Journal& journal,
                   Robots& robots);

/// POST /v1/verifications, POST /v1/verifications/{id}/result, DELETE /v1/verifications/{id}: 201
/// or 200 with the task once it is durable.
void receive_verification(const HttpRequest& request, const HttpReply& reply,
                          Verifications& verifications);

/// GET /v1/verifications and /v1/verifications/{id}.
HttpResponse verification_answer(const HttpTarget& target, const Verifications& verifications);

}  // namespace anchord
