#include "api/replay_note.h"

#include <gtest/gtest.h>

namespace anchord {
namespace {

using nlohmann::json;

Frame frame() {
  Frame frame;
  frame.utime = 1'700'000'000'000'000;
  frame.sensor = "kinect";
  frame.detections.emplace_back().measurement = CartesianMeasurement{{1, 2, 0.3}, {}};
  return frame;
}

TEST(ReplayNote, ComesBackAsItWasWritten) {
  for (const std::size_t size : {0, 1, 2, 3, 4, 255}) {  // base64 ends in each way
    ReplayNote note;
    note.configuration = R"({"world":{"dimensions":2}})";
    note.state.emplace();
    for (std::size_t i = 0; i < size; ++i)
      note.state->checkpoint.push_back(static_cast<std::uint8_t>(i * 37));
    Event event;
    event.kind = Event::Kind::kRemoved;
    event.utime = frame().utime;
    event.object = "cup-1";
    note.state->recent = {{frame(), 17}, {event}};
    note.number = 12;
    note.work = 2000;
    const json text = to_json(note);
    ASSERT_TRUE(is_note(text));
    const auto back = note_from_json(text, 3);
    ASSERT_TRUE(back.ok()) << back.error().text();
    EXPECT_EQ(back->configuration, note.configuration);
    EXPECT_EQ(back->state->checkpoint, note.state->checkpoint) << size;
    ASSERT_EQ(back->state->recent.size(), 2u);
    EXPECT_EQ(std::get<Frame>(back->state->recent[0].what), frame());
    EXPECT_EQ(back->state->recent[0].work, 17u);
    EXPECT_EQ(std::get<Event>(back->state->recent[1].what), event);
    EXPECT_EQ(back->number, 12);
    EXPECT_EQ(back->work, 2000u);
  }
}

TEST(ReplayNote, AFrameIsNone) {
  EXPECT_FALSE(is_note(json::parse(R"({"utime": 1, "detections": []})")));
  EXPECT_FALSE(is_note(json::parse("[1]")));
}

TEST(ReplayNote, RefusesWhatCannotBeByItsField) {
  const std::pair<const char*, const char*> cases[] = {
      {R"({"utime": 1})", ""},
      {R"({"configuration": "{}"})", "configuration"},
      {R"({"state": []})", "state.checkpoint"},
      {R"({"state": {"checkpoint": "a b"}})", "state.checkpoint"},
      {R"({"state": {"checkpoint": "", "recent": {}}})", "state.recent"},
      {R"({"state": {"checkpoint": "", "recent": [7]}})", "state.recent"},
      {R"({"state": {"checkpoint": "", "recent": [{"frame": {}}]}})", "utime"},
      {R"({"next": 3})", "next"},
      {R"({"next": {"number": -3}})", "next.number"},
      {R"({"next": {"work": 1.5}})", "next.work"}};
  for (const auto& [text, field] : cases) {
    const auto note = note_from_json(json::parse(text), 3);
    ASSERT_FALSE(note.ok()) << text;
    EXPECT_EQ(note.error().field, field) << text;
  }
}

}  // namespace
}  // namespace anchord
