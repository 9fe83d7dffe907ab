#pragma once

#include <optional>
#include <string>

#include "api/http_server.h"
#include "daemon/journal.h"
#include "daemon/past.h"
#include "daemon/worker.h"

namespace anchord {

/// Answers what is asked of the log: what was believed at earlier times, histories, and in which
/// frame an object was last seen. On threads of its own, so that neither frames nor questions about
/// the present wait: one folds, the other looks things up.
class Archive {
 public:
  /// Questions that may wait for each; more get 503.
  static constexpr std::size_t kWaiting = 32;
  /// Samples that one answer about a history has, about.
  static constexpr std::int64_t kSamples = 1000;

  /// `now`: an empty world of the configuration that runs.
  Archive(const Journal& journal, const std::string& directory, const World& now);
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;

  /// Whether a question needs it: `at` is what it asked for, its target is without it.
  static bool concerns(const HttpTarget& target, std::optional<Utime> at);
  /// Answers such a question.
  void answer(const HttpTarget& target, std::optional<Utime> at, const HttpReply& reply);

  /// Answers what waits, then nothing more.
  void stop();

 private:
  void post(Worker& worker, const HttpReply& reply, std::function<HttpResponse()> task);
  HttpResponse history(const HttpTarget& target, std::optional<Utime> at);
  FramesAt frames_at(Past& past) const;

  const Journal& journal_;
  Past past_, lookup_;
  Worker folds_, lookups_;  ///< last, so that they end first
};

}  // namespace anchord
