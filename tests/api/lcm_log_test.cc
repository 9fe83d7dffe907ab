#include "api/lcm_log.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <lcm/lcm-cpp.hpp>
#include <sstream>
#include <string>

#include "lcmtypes/channels.h"
#include "lcmtypes/codec.h"
#include "lcmtypes/names.h"
#include "tests/lcmtypes/sample_frames.h"

namespace anchord {
namespace {

Frame frame_at(Utime utime) {
  Frame frame = testing::full_frame();
  frame.utime = utime;
  return frame;
}

/// A log of three frames with an event of another channel between them.
std::string sample_log() {
  std::ostringstream stream;
  LcmLogWriter writer(stream);
  EXPECT_TRUE(writer.write_frame(frame_at(1)).ok());
  const std::vector<std::uint8_t> image(1000, 7);
  EXPECT_TRUE(writer.write("CAMERA", 2, image).ok());
  EXPECT_TRUE(writer.write_frame(frame_at(3)).ok());
  EXPECT_TRUE(writer.write_frame(frame_at(4)).ok());
  return stream.str();
}

struct Outcome {
  std::vector<Utime> frames;
  std::vector<std::int64_t> numbers;
  std::optional<Error> error;
};

Outcome read_all(const std::string& log) {
  std::istringstream stream(log);
  LcmLogReader reader(stream);
  Outcome outcome;
  while (true) {
    const auto next = reader.next_frame();
    if (!next) outcome.error = next.error();
    if (!next || !*next) return outcome;
    outcome.frames.push_back((*next)->frame.utime);
    outcome.numbers.push_back((*next)->seq);
  }
}

TEST(LcmLog, GivesBackFramesAndSkipsOtherChannels) {
  const Outcome outcome = read_all(sample_log());
  EXPECT_FALSE(outcome.error);
  EXPECT_EQ(outcome.frames, (std::vector<Utime>{1, 3, 4}));
  EXPECT_EQ(outcome.numbers, (std::vector<std::int64_t>{1, 2, 3}));
  EXPECT_TRUE(read_all("").frames.empty());
  EXPECT_FALSE(read_all("").error);
}

TEST(LcmLog, LiblcmReadsWhatIsWritten) {
  std::string path = ::testing::TempDir() + "anchord-lcm-log-XXXXXX";
  const int file = mkstemp(path.data());
  ASSERT_GE(file, 0);
  const std::string log = sample_log();
  ASSERT_EQ(write(file, log.data(), log.size()), static_cast<ssize_t>(log.size()));
  close(file);
  lcm::LogFile reader(path, "r");
  std::remove(path.c_str());
  std::vector<std::string> channels;
  std::vector<std::int64_t> numbers, times;
  while (const lcm::LogEvent* event = reader.readNextEvent()) {
    channels.push_back(event->channel);
    numbers.push_back(event->eventnum);
    times.push_back(event->timestamp);
  }
  const std::string frames = kDetectionsChannel;
  EXPECT_EQ(channels, (std::vector<std::string>{frames, "CAMERA", frames, frames}));
  EXPECT_EQ(numbers, (std::vector<std::int64_t>{0, 1, 2, 3}));
  EXPECT_EQ(times, (std::vector<std::int64_t>{1, 2, 3, 4}));
}

TEST(LcmLog, ReadsWhatLiblcmWrites) {
  std::string path = ::testing::TempDir() + "anchord-lcm-log-XXXXXX";
  const int file = mkstemp(path.data());
  ASSERT_GE(file, 0);
  close(file);
  std::vector<std::uint8_t> bytes = encode(frame_at(5), 9);
  {
    lcm::LogFile writer(path, "w");
    lcm::LogEvent event;
    event.timestamp = 6;
    event.channel = kDetectionsChannel;
    event.data = bytes.data();
    event.datalen = static_cast<int>(bytes.size());
    ASSERT_EQ(writer.writeEvent(&event), 0);
  }
  std::ifstream stream(path, std::ios::binary);
  std::remove(path.c_str());
  LcmLogReader reader(stream);
  const auto read = reader.next_frame();
  ASSERT_TRUE(read.ok() && *read);
  EXPECT_EQ((*read)->frame, frame_at(5));
  EXPECT_EQ((*read)->seq, 9);
}

TEST(LcmLog, RefusesALogThatEndsInsideAnEvent) {
  const std::string log = sample_log();
  int whole = 0;
  for (std::size_t size = 0; size < log.size(); ++size) {
    const Outcome outcome = read_all(log.substr(0, size));
    if (!outcome.error) ++whole;
  }
  EXPECT_EQ(whole, 4);  // nothing, one, two and three whole events
}

TEST(LcmLog, RefusesHeadersThatLie) {
  const std::string log = sample_log();
  const auto with = [&](std::size_t at, const std::string& bytes) {
    std::string changed = log;
    changed.replace(at, bytes.size(), bytes);
    const Outcome outcome = read_all(changed);
    return outcome.error ? outcome.error->text() : "accepted";
  };
  const std::string zero(4, '\0'), negative(4, '\xff'), huge("\x7f\xff\xff\xff");
  EXPECT_EQ(with(0, zero), "event[0]: no event of an LCM log starts here");
  EXPECT_EQ(with(20, zero), "event[0]: the channel's length must be 1 to 1000");
  EXPECT_EQ(with(20, negative), "event[0]: the channel's length must be 1 to 1000");
  EXPECT_EQ(with(20, huge), "event[0]: the channel's length must be 1 to 1000");
  EXPECT_EQ(with(24, negative), "event[0]: the data's length must not be negative");
  EXPECT_EQ(with(24, huge), "event[0]: the log ends inside an event");
}

TEST(LcmLog, AfterARefusedFrameReadingGoesOn) {
  std::ostringstream log;
  LcmLogWriter writer(log);
  ASSERT_TRUE(writer.write_frame(frame_at(1)).ok());
  std::vector<std::uint8_t> cut = encode(frame_at(2), 2);
  cut.pop_back();
  ASSERT_TRUE(writer.write(kDetectionsChannel, 2, cut).ok());
  ASSERT_TRUE(
      writer.write(kDetectionsChannel, 3, std::vector<std::uint8_t>(kMaxMessageBytes + 1)).ok());
  ASSERT_TRUE(writer.write_frame(frame_at(4)).ok());

  std::istringstream stream(log.str());
  LcmLogReader reader(stream);
  EXPECT_TRUE(reader.next_frame().ok());
  const auto refused = reader.next_frame();
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().field, "event[1].detections[2].num_attributes");
  const auto too_large = reader.next_frame();
  ASSERT_FALSE(too_large.ok());
  EXPECT_EQ(too_large.error().field, "event[2]");
  const auto last = reader.next_frame();
  ASSERT_TRUE(last.ok() && *last);
  EXPECT_EQ((*last)->frame.utime, 4);
  EXPECT_EQ(reader.events(), 4);
}

TEST(LcmLog, SaysWhenItCannotWrite) {
  std::ostringstream stream;
  stream.setstate(std::ios::badbit);
  LcmLogWriter writer(stream);
  const Status written = writer.write_frame(frame_at(1));
  ASSERT_FALSE(written.ok());
  EXPECT_EQ(written.error().code, ErrorCode::kIo);
}

TEST(LcmLog, GivesBackFramesAndEventsInTheirOrder) {
  std::ostringstream stream;
  LcmLogWriter writer(stream);
  Event done;
  done.kind = Event::Kind::kNamed;
  done.utime = 2;
  done.object = "cup-1";
  done.other = "my mug";
  EXPECT_TRUE(writer.write_frame(frame_at(1)).ok());
  EXPECT_TRUE(writer.write_event(done).ok());
  EXPECT_TRUE(writer.write("CAMERA", 2, std::vector<std::uint8_t>(10, 7)).ok());
  EXPECT_TRUE(writer.write(kEventChannel, 2, std::vector<std::uint8_t>(10, 7)).ok());
  EXPECT_TRUE(writer.write_frame(frame_at(3)).ok());
  std::istringstream log(stream.str());
  LcmLogReader reader(log);
  auto next = reader.next_input();
  ASSERT_TRUE(next && *next);
  EXPECT_EQ(std::get<Frame>(**next).utime, 1);
  next = reader.next_input();
  ASSERT_TRUE(next && *next);
  EXPECT_EQ(std::get<Event>(**next), done);
  next = reader.next_input();
  ASSERT_FALSE(next.ok()) << "no event";
  EXPECT_TRUE(next.error().field.starts_with("event[3]")) << next.error().text();
  next = reader.next_input();
  ASSERT_TRUE(next && *next);
  EXPECT_EQ(std::get<Frame>(**next).utime, 3);
  next = reader.next_input();
  EXPECT_TRUE(next && !*next);
  std::istringstream again(stream.str());
  LcmLogReader frames(again);
  EXPECT_EQ((*frames.next_frame())->frame.utime, 1);
  EXPECT_EQ((*frames.next_frame())->frame.utime, 3);
}

}  // namespace
}  // namespace anchord
