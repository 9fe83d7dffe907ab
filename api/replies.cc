#include "api/replies.h"

#include <anchord/answer_t.hpp>
#include <anchord/rejected_t.hpp>

#include "lcmtypes/codec.h"

namespace anchord {

std::vector<std::uint8_t> encode_answer(std::int64_t id, const HttpResponse& response) {
  answer_t out{};
  out.id = id;
  out.status = response.status;
  out.json = response.body;
  return encode_message(out);
}

std::vector<std::uint8_t> encode_refusal(const std::string& origin, const Frame* frame,
                                         const Error& why, Utime utime) {
  rejected_t out{};
  out.utime = utime;
  out.channel = origin;
  if (frame) {
    out.sensor = frame->sensor;
    out.frame_utime = frame->utime;
  }
  out.field = why.field;
  out.reason = why.message;
  return encode_message(out);
}

}  // namespace anchord
