#include "daemon/lcm_records.h"

#include <gtest/gtest.h>

#include <random>

#include "lcmtypes/names.h"

namespace anchord {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Kind = LcmRecord::Kind;

struct Read {
  Kind kind;
  int channel;
  Bytes bytes;
  bool operator==(const Read&) const = default;
};

TEST(LcmRecords, ComeThroughHoweverTheStreamIsCut) {
  std::vector<Read> written = {{Kind::kJoined, 0, {}},
                               {Kind::kMessage, 0, Bytes(100'000, 7)},
                               {Kind::kMessage, 5, {1}},
                               {Kind::kMessage, 3, {}},
                               {Kind::kRefused, 1, refusal_bytes({ErrorCode::kInvalid, "a", "b"})}};
  Bytes stream;
  for (const Read& one : written)
    append({one.kind, static_cast<std::uint8_t>(one.channel), one.bytes}, stream);
  std::mt19937 dice(3);
  for (const std::size_t most : {3u, 20u, 200'000u}) {
    LcmRecords records;
    std::vector<Read> read;
    for (std::size_t at = 0; at < stream.size();) {
      const std::size_t size = std::min<std::size_t>(1 + dice() % most, stream.size() - at);
      records.add(std::span(stream).subspan(at, size));
      at += size;
      while (true) {
        const auto record = records.next();
        ASSERT_TRUE(record.ok());
        if (!*record) break;
        const auto bytes = (*record)->bytes;
        read.push_back({(*record)->kind, (*record)->channel, Bytes(bytes.begin(), bytes.end())});
      }
    }
    EXPECT_EQ(read, written);
  }
}

TEST(LcmRecords, NonsenseIsAnError) {
  const Bytes message(10);
  for (const LcmRecord& wrong :
       {LcmRecord{static_cast<Kind>(6), 0, message},
        LcmRecord{Kind::kMessage, static_cast<std::uint8_t>(kReceivedChannels.size()), message}}) {
    Bytes stream;
    append(wrong, stream);
    LcmRecords records;
    records.add(stream);
    EXPECT_FALSE(records.next().ok());
  }
  Bytes stream;
  append({Kind::kMessage, 0, Bytes(kMaxMessageBytes + 1)}, stream);
  LcmRecords records;
  records.add(std::span(stream).first(8));
  EXPECT_FALSE(records.next().ok()) << "before its bytes are waited for";
}

TEST(LcmRecords, RefusalsAndDropsKeepWhatTheySay) {
  const Error why{ErrorCode::kInvalid, "detections[3].position", "has a NaN"};
  EXPECT_EQ(refusal(refusal_bytes(why)).field, why.field);
  EXPECT_EQ(refusal(refusal_bytes(why)).message, why.message);
  EXPECT_EQ(refusal({}).message, "");
  const auto bytes = drops_bytes({3, 1u << 20});
  EXPECT_EQ(drops(bytes).waiting, 3u);
  EXPECT_EQ(drops(bytes).by_kernel, 1u << 20);
  EXPECT_EQ(drops(std::span(bytes).first(7)).waiting, 0u) << "of another length";
}

}  // namespace
}  // namespace anchord
