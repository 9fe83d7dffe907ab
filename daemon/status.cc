#include "daemon/status.h"

#include <filesystem>

#include "api/belief_json.h"

namespace anchord {
namespace {

struct BeliefSize {
  std::size_t objects = 0, anchors = 0, hypotheses = 0;
  double expected = 0;
};

BeliefSize size_of(const Belief& belief, const Background& background) {
  BeliefSize size;
  for (const auto& cluster : belief.clusters) {
    size.anchors += cluster->anchors.size();
    size.hypotheses += cluster->hypotheses.size();
    for (int a = 0; a < static_cast<int>(cluster->anchors.size()); ++a) {
      size.expected += cluster->existence(a, background);
      const Leaf* best = cluster->best_leaf(a);
      size.objects += best && real_existence(*best, background) >= kBelievedIn ? 1 : 0;
    }
  }
  return size;
}

/// 0 where it cannot be read.
std::uintmax_t bytes_in(const std::string& directory) {
  std::uintmax_t sum = 0;
  std::error_code error;
  for (std::filesystem::directory_iterator file(directory, error), end; !error && file != end;
       file.increment(error)) {
    std::error_code gone;  // SQLite removes files at any time
    const auto bytes = file->file_size(gone);
    if (!gone) sum += bytes;
  }
  return sum;
}

/// Lines of Prometheus' text format.
class Metrics {
 public:
  template <typename Number>
  void add(const char* name, const char* type, const char* help, Number value) {
    text_ += std::string("# HELP anchord_") + name + " " + help + "\n# TYPE anchord_" + name + " " +
             type + "\nanchord_" + name + " " + Json(value).dump() + "\n";
  }
  std::string text() && { return std::move(text_); }

 private:
  std::string text_;
};

}  // namespace

HttpResponse status_answer(const StatusSources& from) {
  const Snapshot snapshot = from.journal.snapshot();
  const auto& belief = snapshot.belief;
  const BeliefSize size = size_of(*belief, *snapshot.background);
  const Statistics& s = from.statistics;
  const auto times = from.times.summary();
  Json out{{"version", ANCHORD_VERSION},
           {"ready", from.ready},
           {"utime", belief->utime},
           {"uptime_s", from.uptime_s},
           {"objects", size.objects},
           {"anchors", size.anchors},
           {"expected_count", size.expected},
           {"hypotheses", size.hypotheses},
           {"clusters", belief->clusters.size()},
           {"dropped_probability", belief->effort.dropped}};
  out["frames"] = {{"accepted", s.accepted.load()}, {"repeated", s.repeated.load()},
                   {"refused", s.refused.load()},   {"unstored", s.unstored.load()},
                   {"ahead", s.ahead.load()},       {"overrun", s.overrun.load()},
                   {"late", s.late.load()},         {"lost", s.lost.load()},
                   {"cut", belief->cut_frames}};
  const Intake::State waiting = from.journal.waiting();
  out["queue"] = {{"frames", waiting.frames},
                  {"capacity", Intake::kFrames},
                  {"overloaded", waiting.overloaded},
                  {"overloaded_s", waiting.overloaded_s}};
  out["update_us"] = {{"median", times.median_us}, {"p99", times.p99_us}, {"max", times.max_us}};
  const Journal::Kept kept = from.journal.kept();
  out["log"] = {{"directory", from.data_directory},
                {"frames", from.journal.logged_frames()},
                {"first", kept.first},
                {"checkpoint", from.journal.checkpoint()},
                {"bytes", bytes_in(from.data_directory)},
                {"used_bytes", kept.used},
                {"free_bytes", kept.free},
                {"checkpoint_bytes", kept.checkpoints},
                {"checkpoint_pause_ms", kept.longest_pause * 1e3},
                {"commits", s.commits.load()},
                {"failures", s.commit_failures.load()}};
  out["lcm"] = {{"url", from.lcm_url},
                {"frames", s.received_lcm.load()},
                {"refused", s.refused_lcm.load()},
                {"published", s.published_lcm.load()},
                {"receiving", from.lcm.receiving.load()},
                {"restarts", from.lcm.restarts.load()},
                {"dropped", from.lcm.dropped.load()},
                {"dropped_by_kernel", from.lcm.dropped_by_kernel.load()}};
  const auto [queued, issued] = from.verifications.open();
  out["verifications"] = {{"queued", queued}, {"issued", issued}};
  out["http"] = {{"address", from.http_address}};
  if (from.http) {
    const HttpCounters& http = from.http->counters();
    out["http"]["connections"] = http.open.load();
    out["http"]["requests"] = http.requests.load();
    out["http"]["refused"] = http.refused.load();
    out["http"]["evicted"] = http.evicted.load();
    out["http"]["unauthorized"] = http.unauthorized.load();
    out["http"]["foreign"] = http.foreign.load();
    out["http"]["client_errors"] = http.responses[4].load();
    out["http"]["streams"] = http.streams.load();
    out["http"]["streams_refused"] = http.streams_refused.load();
    out["http"]["streamed"] = http.streamed.load();
    out["http"]["streamed_bytes"] = http.streamed_bytes.load();
    out["http"]["timeouts"] = http.request_timeouts.load() + http.write_timeouts.load();
  }
  return {200, "application/json", out.dump() + "\n", {}};
}

HttpResponse metrics_answer(const StatusSources& from) {
  const Snapshot snapshot = from.journal.snapshot();
  const auto& belief = snapshot.belief;
  const BeliefSize size = size_of(*belief, *snapshot.background);
  const Statistics& s = from.statistics;
  const auto times = from.times.summary();
  Metrics out;
  out.add("ready", "gauge", "1 once the belief is restored", from.ready ? 1 : 0);
  out.add("frames_accepted_total", "counter", "frames applied and durable", s.accepted.load());
  out.add("frames_repeated_total", "counter", "frames sent again", s.repeated.load());
  out.add("frames_refused_total", "counter", "frames refused", s.refused.load());
  out.add("frames_unstored_total", "counter", "frames refused, the disk is full or fails",
          s.unstored.load());
  out.add("frames_ahead_total", "counter", "frames refused, too far ahead of the clock",
          s.ahead.load());
  out.add("frames_overrun_total", "counter", "frames dropped, too many waiting", s.overrun.load());
  const Intake::State waiting = from.journal.waiting();
  out.add("queue_frames", "gauge", "frames that wait to be applied", waiting.frames);
  out.add("overloaded", "gauge", "1 while frames are refused for want of room",
          waiting.overloaded ? 1 : 0);
  out.add("frames_late_total", "counter", "frames put in place behind newer ones", s.late.load());
  out.add("frames_lost_total", "counter", "gaps in publishers' numbering", s.lost.load());
  out.add("frames_cut_total", "counter", "frames whose budget left out hypotheses",
          belief->cut_frames);
  out.add("dropped_probability_total", "counter", "probability of hypotheses that were left out",
          belief->dropped);
  out.add("lcm_frames_received_total", "counter", "frames over LCM", s.received_lcm.load());
  out.add("lcm_refused_total", "counter", "messages over LCM refused", s.refused_lcm.load());
  out.add("lcm_published_total", "counter", "messages sent over LCM", s.published_lcm.load());
  out.add("lcm_receiving", "gauge", "1 while LCM is heard", from.lcm.receiving ? 1 : 0);
  out.add("lcm_restarts_total", "counter", "starts of the process that receives LCM after it died",
          from.lcm.restarts.load());
  out.add("lcm_dropped_total", "counter", "messages dropped, too many waited to be passed on",
          from.lcm.dropped.load());
  out.add("lcm_dropped_by_kernel_total", "counter", "datagrams that found no room in the kernel",
          from.lcm.dropped_by_kernel.load());
  out.add("log_commits_total", "counter", "batches made durable", s.commits.load());
  out.add("log_failures_total", "counter", "batches that failed", s.commit_failures.load());
  const Journal::Kept kept = from.journal.kept();
  out.add("log_first_frame", "gauge", "number of the oldest frame in the log", kept.first);
  out.add("log_bytes", "gauge", "bytes of the data directory", bytes_in(from.data_directory));
  out.add("log_used_bytes", "gauge", "bytes of the log's database in use", kept.used);
  out.add("log_free_bytes", "gauge", "bytes of the log's database to be used again", kept.free);
  out.add("checkpoint_bytes", "gauge", "bytes of all checkpoints", kept.checkpoints);
  out.add("checkpoint_pause_seconds", "gauge", "longest for which a checkpoint held up frames",
          kept.longest_pause);
  out.add("queries_total", "counter", "questions asked", s.queries.load());
  out.add("update_seconds_sum", "counter", "time spent on updates", times.sum_s);
  out.add("update_seconds_count", "counter", "updates", times.count);
  out.add("update_p99_seconds", "gauge", "99 % of the latest updates took less",
          times.p99_us * 1e-6);
  out.add("objects", "gauge", "objects in the best world", size.objects);
  out.add("anchors", "gauge", "anchors in any hypothesis", size.anchors);
  out.add("expected_count", "gauge", "expected number of objects", size.expected);
  out.add("hypotheses", "gauge", "hypotheses kept", size.hypotheses);
  out.add("clusters", "gauge", "independent clusters", belief->clusters.size());
  const auto [queued, issued] = from.verifications.open();
  out.add("verifications_queued", "gauge", "verification tasks that wait", queued);
  out.add("verifications_issued", "gauge", "verification tasks that are being done", issued);
  if (from.http) {
    const HttpCounters& http = from.http->counters();
    out.add("http_connections", "gauge", "open connections", http.open.load());
    out.add("http_requests_total", "counter", "requests read whole", http.requests.load());
    out.add("http_refused_total", "counter", "connections over the limit", http.refused.load());
    out.add("http_evicted_total", "counter", "idle connections that made room for new ones",
            http.evicted.load());
    out.add("http_unauthorized_total", "counter", "requests without the token",
            http.unauthorized.load());
    out.add("http_foreign_total", "counter", "requests for other hosts or from other origins",
            http.foreign.load());
    out.add("http_client_errors_total", "counter", "answers with status 4xx",
            http.responses[4].load());
    out.add("http_streams", "gauge", "open streams", http.streams.load());
    out.add("http_streams_refused_total", "counter", "streams ended for what their clients said",
            http.streams_refused.load());
    out.add("http_streamed_total", "counter", "messages of streams", http.streamed.load());
    out.add("http_streamed_bytes_total", "counter", "of these", http.streamed_bytes.load());
    out.add("http_timeouts_total", "counter", "clients that were too slow",
            http.request_timeouts.load() + http.write_timeouts.load());
  }
  return {200, "text/plain; version=0.0.4", std::move(out).text(), {}};
}

}  // namespace anchord
