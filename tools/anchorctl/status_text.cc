#include "tools/anchorctl/answers.h"
#include "tools/anchorctl/format.h"

namespace anchord {
namespace {

/// The numbers of `part` with their names: "1200 accepted, 0 refused". Those that are missing are
/// left out.
std::string counters(const Json& part, std::initializer_list<const char*> names) {
  std::string written;
  for (const char* name : names) {
    if (const auto count = number(part, name)) {
      written += (written.empty() ? "" : ", ") + glued(decimal(*count, 0) + " " + name);
    }
  }
  return written;
}

std::string after(const std::string& first, const std::string& rest) {
  return first + (first.empty() || rest.empty() ? "" : ", ") + rest;
}

std::string belief(const Json& status) {
  std::string written = counters(status, {"objects", "anchors"});
  if (const auto expected = number(status, "expected_count")) {
    written = after(written, glued(decimal(*expected) + " expected"));
  }
  return after(written, counters(status, {"hypotheses", "clusters"}));
}

std::string update_times(const Json& update) {
  std::string written;
  for (const char* name : {"median", "p99", "max"}) {
    if (const auto time_us = number(update, name)) {
      written = after(written, glued(std::string(name) + " " + duration(*time_us * 1e-6)));
    }
  }
  return written;
}

std::string stored(const Json& log) {
  const auto size = number(log, "bytes");
  return after(after(text(log, "directory", ""), counters(log, {"frames"})),
               size ? glued(bytes(*size)) : "");
}

std::string waiting(const Json& queue) {
  const auto frames = number(queue, "frames"), capacity = number(queue, "capacity");
  if (!frames || !capacity) return "";
  const std::string filled = decimal(*frames, 0) + " of " + decimal(*capacity, 0) + " frames";
  const auto time_s = number(queue, "overloaded_s");
  return after(filled, flag(queue, "overloaded") && time_s
                           ? glued("overloaded for " + duration(*time_s))
                           : "");
}

std::string heard(const Json& lcm) {
  const auto lost = number(lcm, "dropped_by_kernel");
  return after(counters(lcm, {"frames", "refused", "published", "restarts", "dropped"}),
               lost ? glued(decimal(*lost, 0) + " dropped by the kernel") : "");
}

}  // namespace

std::string status_text(const Json& answer, const std::string& server, const Style& style) {
  Table table({{""}, {"", true}});
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) table.add({name, value});
  };
  add("daemon", "anchord " + text(answer, "version", "of unknown version") + " at " + server +
                    (flag(answer, "ready") ? ", ready" : ", not ready"));
  if (const auto uptime_s = number(answer, "uptime_s")) add("up for", duration(*uptime_s));
  add("newest frame", date_and_time(utime(answer, "utime")));
  add("frames", counters(items(answer, "frames"), {"accepted", "repeated", "refused", "unstored",
                                                   "ahead", "overrun", "late", "lost", "cut"}));
  add("queue", waiting(items(answer, "queue")));
  add("belief", belief(answer));
  add("update", update_times(items(answer, "update_us")));
  add("log", stored(items(answer, "log")));
  add("tasks", counters(items(answer, "verifications"), {"queued", "issued"}));
  const Json& lcm = items(answer, "lcm");
  add("lcm", after(text(lcm, "url", ""), heard(lcm)));
  const Json& http = items(answer, "http");
  add("http",
      after(text(http, "address", ""), counters(http, {"connections", "requests", "refused"})));
  return table.text(style);
}

}  // namespace anchord
