#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "api/http_message.h"
#include "api/lcm_sender.h"
#include "daemon/journal.h"
#include "daemon/lcm_receiver.h"
#include "daemon/robots.h"
#include "daemon/statistics.h"
#include "daemon/verifications.h"
#include "daemon/worker.h"

namespace anchord {

/// The daemon on LCM: frames and questions in, the best world, answers and refusals out. What comes
/// in is heard by another process; what goes out goes out from this one, through a connection that
/// reads nothing, so that the two cannot harm each other.
class LcmFront {
 public:
  /// What answers the target of a question; called on a thread of the front's own.
  using Answerer = std::function<HttpResponse(const HttpTarget&)>;

  /// Nothing is received before start().
  LcmFront(std::unique_ptr<LcmSender> sender, std::unique_ptr<LcmReceiver> receiver,
           Statistics& statistics);
  LcmFront(const LcmFront&) = delete;
  LcmFront& operator=(const LcmFront&) = delete;

  void start(Journal& journal, Verifications& verifications, Robots& robots, Answerer answerer);
  /// Receives no more, and answers the questions that wait; the journal may go then.
  void stop();

  /// Publishes the best world of a belief, on a thread of the front's own. Where that thread is far
  /// behind, a world is left out, which shows as a gap in `seq`. One thread at a time.
  void publish_world(std::shared_ptr<const Belief> belief,
                     std::shared_ptr<const Background> background);
  /// Publishes a task as it is now, on a thread of the front's own. Safe from any thread.
  void publish_task(const Task& task, Utime now);
  /// Publishes a refusal on ANCHORD_REJECTED, on another thread, unless very many wait there.
  /// `frame` is null if it could not be read. Safe from any thread.
  void publish_refusal(const std::string& origin, const Frame* frame, const Error& why);

  const std::string& url() const { return sender_->url(); }
  const LcmReceiver::Counters& received() const { return receiver_->counters(); }

 private:
  void receive_frame(std::span<const std::uint8_t> bytes, Journal& journal);
  void receive_event(std::span<const std::uint8_t> bytes, Journal& journal, Robots& robots);
  void receive_trigger(std::span<const std::uint8_t> bytes, Verifications& verifications);
  void receive_result(std::span<const std::uint8_t> bytes, Verifications& verifications);
  void receive_pose(std::span<const std::uint8_t> bytes, Verifications& verifications);
  void receive_refusal(const char* channel, const Error& why);
  void refuse(const char* channel, const Error& why);
  void receive_query(std::span<const std::uint8_t> bytes, const Answerer& answerer);
  void send(const char* channel, const std::vector<std::uint8_t>& bytes);

  std::unique_ptr<LcmSender> sender_;
  std::unique_ptr<LcmReceiver> receiver_;
  Statistics& statistics_;
  SequenceGaps gaps_;        // of the receiver's thread
  std::int64_t worlds_ = 0;  // of the thread that calls publish_world()
  // They end before the sender does. What takes long must not keep frames from being received.
  Worker publisher_, refusals_, questions_, triggers_, tasks_;
};

}  // namespace anchord
