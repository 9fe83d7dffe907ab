#include "daemon/archive.h"

#include <algorithm>
#include <utility>

#include "api/at_parameter.h"
#include "daemon/history_recorder.h"
#include "lcmtypes/checked_decode.h"

namespace anchord {
namespace {

constexpr char kHistory[] = "/v1/history";
constexpr char kObject[] = "/v1/objects/";

Json json_of(const HistorySample& sample, int dims) {
  Json position = Json::array();
  for (int axis = 0; axis < dims; ++axis) position.push_back(sample.position[axis]);
  return {{"utime", sample.utime},
          {"p", sample.p},
          {"place", sample.place.empty() ? Json(nullptr) : Json(sample.place)},
          {"position", position},
          {"spread", sample.spread}};
}

/// What is asked of a history, or why that cannot be.
Result<HistorySpan> read_span(const HttpTarget& target) {
  HistorySpan span;
  span.most = Archive::kSamples;
  span.from = kEarliestUtime;
  for (const auto& [name, value] : target.parameters) {
    if (name == "object") {
      if (!span.object.empty()) return invalid(name, "is given twice");
      span.object = value;
    } else if (name == "from" || name == "to") {
      const auto utime = read_utime(name, value);
      if (!utime) return utime.error();
      (name == "from" ? span.from : span.to) = *utime;
    } else {
      return invalid(name, "is no parameter here; there are: object, from, to, at");
    }
  }
  if (span.object.empty()) return invalid("object", "say whose history: object=ID");
  if (span.from > span.to) return invalid("to", "lies before from");
  return span;
}

}  // namespace

Archive::Archive(const Journal& journal, const std::string& directory, const World& now)
    : journal_(journal),
      past_(directory, now),
      lookup_(directory, now),
      folds_(kWaiting),
      lookups_(kWaiting) {}

bool Archive::concerns(const HttpTarget& target, std::optional<Utime> at) {
  return at || target.path == kHistory ||
         (target.path.starts_with(kObject) && target.path.size() > sizeof kObject - 1);
}

void Archive::stop() {
  folds_.stop();
  lookups_.stop();
}

void Archive::post(Worker& worker, const HttpReply& reply, std::function<HttpResponse()> task) {
  if (!worker.post([reply, task = std::move(task)] { reply(task()); }))
    reply(http_error(503, "overloaded", "too many questions about the past wait; ask again"));
}

void Archive::answer(const HttpTarget& target, std::optional<Utime> at, const HttpReply& reply) {
  if (target.path == kHistory)
    return post(lookups_, reply, [this, target, at] { return history(target, at); });
  Snapshot now = journal_.snapshot();
  if (at && *at >= now.belief->utime) now.ahead = *at;
  if (!at || now.ahead > 0) {
    if (!target.path.starts_with(kObject)) return reply(anchord::answer(target, now));
    return post(lookups_, reply,
                [this, target, now] { return anchord::answer(target, now, frames_at(lookup_)); });
  }
  post(folds_, reply, [this, target, at, least = journal_.logged_frames()] {
    const auto then = past_.at(*at, least);
    return then ? anchord::answer(target, *then, frames_at(past_)) : http_error(then.error());
  });
}

FramesAt Archive::frames_at(Past& past) const {
  return [&past](Utime utime) {
    std::vector<NumberedFrame> out;
    const auto log = past.log();
    if (!log) return out;
    const auto logged = (*log)->frames_at(utime);
    if (!logged) return out;
    for (const LoggedFrame& one : *logged)
      if (auto message = decode_frame(one.bytes))
        out.push_back({one.sequence, std::move(message->frame)});
    return out;
  };
}

HttpResponse Archive::history(const HttpTarget& target, std::optional<Utime> at) {
  auto span = read_span(target);
  if (!span) return http_error(span.error());
  if (at) span->to = std::min(span->to, *at);
  const Snapshot now = journal_.snapshot();
  const Background& background = *now.background;
  // An object may be asked for by its alias, too; and what it is now is not in the log yet.
  std::optional<HistorySample> newest;
  for (const auto& cluster : now.belief->clusters)
    for (const ObjectBelief& object : read_objects(*cluster, now.belief->utime, background))
      if (object.anchor->is_called(span->object) && object.p > 0) {
        span->object = object.anchor->id();
        newest = sample_of(object, now.belief->utime, background);
      }
  const auto log = lookup_.log();
  if (!log) return http_error(log.error());
  auto samples = (*log)->history(*span);
  if (!samples) return http_error(samples.error());
  if (samples->empty() && !newest)
    if (const auto ever = (*log)->last_sample(span->object); !ever || !*ever)
      return http_error(Error{ErrorCode::kUnknown, "object",
                              "there is no object \"" + span->object + "\", nor was there one"});
  const Utime from = span->from, to = span->to;
  if (newest && newest->utime >= from && newest->utime <= to &&
      (samples->empty() || samples->back().utime < newest->utime))
    samples->push_back(*newest);
  Json list = Json::array();
  for (const HistorySample& sample : *samples) list.push_back(json_of(sample, background.dims));
  return {
      200,
      "application/json",
      Json{{"utime", now.belief->utime}, {"object", span->object}, {"samples", list}}.dump() + "\n",
      {}};
}

}  // namespace anchord
