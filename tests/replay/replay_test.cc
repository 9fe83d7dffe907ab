// The program itself: frames in, the belief after each out, the same to the byte.

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <variant>

#include "api/event_json.h"
#include "api/frame_json.h"
#include "api/lcm_log.h"
#include "tests/anchoring/dice.h"
#include "tests/anchoring/small_events.h"

namespace anchord {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::string kConfiguration = R"(// Comments are allowed.
{"world": {"dimensions": 2, "bounds": {"min": [0, 0], "max": [6, 4]}},
 "places": [{"name": "sink", "kind": "surface", "polygon": [[4, 3], [5, 3], [5, 4], [4, 4]]}],
 "attributes": {"class": {"kind": "categorical", "symbols": ["cup", "box"]}},
 "sensors": {"default": {"view": {"type": "world"}}}})";

/// Two sensors, three objects, clutter, views, poses and late frames.
std::vector<Frame> random_frames() {
  std::mt19937_64 random(20140601);
  enumeration::Dice dice(random);
  std::vector<Frame> frames;
  for (int step = 0; step < 60; ++step) {
    const bool left = step % 2 == 0;
    Frame f = frame(0.1 * step - (left ? 0 : 0.15), {}, left ? "left" : "right");
    if (left) f.pose = Pose{{0.5, 0.1, 0}, {std::cos(0.1), 0, 0, std::sin(0.1)}, {}};
    for (int object = 0; object < 3; ++object) {
      if (dice.chance(0.2)) continue;
      Detection z = at(1 + object + 0.1 * dice.normal(), 1 + 0.1 * dice.normal(), 0.01);
      z.score = dice.uniform(0.3, 1);
      z.attributes.push_back({"class", SymbolReport{{{object == 1 ? "box" : "cup", 0.8}}}});
      f.detections.push_back(z);
    }
    if (dice.chance(0.5)) f.detections.push_back(at(dice.uniform(0, 6), dice.uniform(0, 4), 0.01));
    frames.push_back(f);
  }
  return frames;
}

std::string lines_of(const std::vector<Frame>& frames) {
  std::string out;
  for (const Frame& f : frames) out += to_json(f).dump() + "\n";
  return out;
}

/// The frames, and between them what was done and said; one late, one ahead.
std::vector<std::variant<Frame, Event>> random_inputs() {
  std::vector<std::variant<Frame, Event>> inputs;
  const auto frames = random_frames();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    inputs.emplace_back(frames[i]);
    const double now = 0.1 * static_cast<double>(i);
    if (i == 10) inputs.emplace_back(missing(now - 0.2, "cup-1", box_of_interest(0, 0, 2, 2)));
    if (i == 15) inputs.emplace_back(named(now, "cup-1", "my mug"));
    if (i == 20) inputs.emplace_back(event(Event::Kind::kGrasped, now + 0.2, "my mug"));
    if (i == 22) inputs.emplace_back(carried(now, 3, 3));
    if (i == 30) inputs.emplace_back(in_place(event(Event::Kind::kPlaced, now, "my mug"), "sink"));
    if (i == 40) inputs.emplace_back(event(Event::Kind::kDropped, now, "cup-1"));
    if (i == 42) inputs.emplace_back(undone(now, 47));  // 41 frames and 5 events before it
  }
  return inputs;
}

std::string lines_of(const std::vector<std::variant<Frame, Event>>& inputs) {
  std::string out;
  for (const auto& input : inputs)
    out += std::visit([](const auto& one) { return to_json(one).dump(); }, input) + "\n";
  return out;
}

std::string text_of(const fs::path& file) {
  std::ostringstream out;
  out << std::ifstream(file, std::ios::binary).rdbuf();
  return out.str();
}

std::vector<std::string> split_lines(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

class Replay : public testing::Test {
 protected:
  Replay() {
    std::string name = (fs::temp_directory_path() / "anchor-replay-XXXXXX").string();
    if (mkdtemp(name.data())) folder_ = name;
    write("world.json", kConfiguration);
    write("frames.jsonl", lines_of(random_frames()));
  }
  ~Replay() override {
    std::error_code ignored;
    if (!folder_.empty()) fs::remove_all(folder_, ignored);
  }

  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  std::string read(const std::string& name) const { return text_of(folder_ / name); }

  /// Runs anchor-replay by a shell, in the folder; `arguments` may redirect. Its exit status; what
  /// it wrote to standard output is in the file "out", to standard error in "err".
  int run(const std::string& arguments) const {
    const std::string command =
        "cd '" + folder_.string() + "' && '" ANCHOR_REPLAY "' " + arguments + " > out 2> err";
    const int ended = std::system(command.c_str());
    return WIFEXITED(ended) ? WEXITSTATUS(ended) : -1;
  }

  fs::path folder_;
};

const std::string kRun = "--config world.json --no-timing --input ";

TEST_F(Replay, TwoRunsGiveTheSameBytes) {
  ASSERT_EQ(run(kRun + "frames.jsonl --all --hypotheses 3"), 0) << read("err");
  const std::string first = read("out");
  ASSERT_EQ(run(kRun + "frames.jsonl --all --hypotheses 3 --output world.jsonl"), 0);
  EXPECT_EQ(read("world.jsonl"), first);
  EXPECT_EQ(read("out"), "");
  const auto lines = split_lines(first);
  ASSERT_EQ(lines.size(), random_frames().size());
  const json last = json::parse(lines.back());
  EXPECT_EQ(last["utime"], at_second(5.8)) << "the newest, though the last was late";
  EXPECT_GE(last["objects"].size(), 3u);
}

TEST_F(Replay, AnLcmLogGivesTheSameBytesAsJsonLines) {
  for (const char* name : {"frames.lcm", "frames.lcmlog"}) {
    std::ofstream stream(folder_ / name, std::ios::binary);
    LcmLogWriter log(stream);
    for (const Frame& f : random_frames()) ASSERT_TRUE(log.write_frame(f).ok());
  }
  ASSERT_EQ(run(kRun + "frames.jsonl --all"), 0);
  const std::string from_json = read("out");
  for (const char* name : {"frames.lcm", "frames.lcmlog"}) {
    ASSERT_EQ(run(kRun + name + " --all"), 0) << read("err");
    EXPECT_EQ(read("out"), from_json);
  }
}

TEST_F(Replay, EventsAmongFramesEachGetALine) {
  const auto inputs = random_inputs();
  write("frames.jsonl", lines_of(inputs));
  ASSERT_EQ(run(kRun + "frames.jsonl --all --stats stats.json"), 0) << read("err");
  const auto lines = split_lines(read("out"));
  ASSERT_EQ(lines.size(), inputs.size());
  const json stats = json::parse(read("stats.json"));
  EXPECT_EQ(stats["frames"], random_frames().size());
  EXPECT_EQ(stats["events"], 7);
  bool held = false;
  json before;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const json line = json::parse(lines[i]);
    if (std::holds_alternative<Event>(inputs[i])) {
      EXPECT_EQ(line["utime"], before["utime"]);
      EXPECT_NE(line, before) << "line " << i + 1;
    }
    for (const json& object : line["objects"])
      held = held || (object.contains("held_by") && object["alias"] == "my mug");
    before = line;
  }
  EXPECT_TRUE(held);
  EXPECT_NE(lines.back().find("my mug"), std::string::npos) << "dropped, and undone";
}

TEST_F(Replay, AnLcmLogOfEventsGivesTheSameBytesAsJsonLines) {
  const auto inputs = random_inputs();
  write("frames.jsonl", lines_of(inputs));
  std::ofstream stream(folder_ / "frames.lcm", std::ios::binary);
  LcmLogWriter log(stream);
  for (const auto& input : inputs) {
    const auto* f = std::get_if<Frame>(&input);
    ASSERT_TRUE(f ? log.write_frame(*f).ok() : log.write_event(std::get<Event>(input)).ok());
  }
  stream.close();
  ASSERT_EQ(run(kRun + "frames.jsonl --all --hypotheses 3"), 0) << read("err");
  const std::string from_json = read("out");
  ASSERT_EQ(run(kRun + "frames.jsonl --all --hypotheses 3"), 0);
  EXPECT_EQ(read("out"), from_json) << "another run";
  ASSERT_EQ(run(kRun + "frames.lcm --all --hypotheses 3"), 0) << read("err");
  EXPECT_EQ(read("out"), from_json);
}

TEST_F(Replay, AnEventSentAgainIsPassedOver) {
  auto inputs = random_inputs();
  write("frames.jsonl", lines_of(inputs));
  ASSERT_EQ(run(kRun + "frames.jsonl"), 0);
  const std::string once = read("out");
  const auto first = std::find_if(inputs.begin(), inputs.end(), [](const auto& input) {
    return std::holds_alternative<Event>(input);
  });
  const auto again = *first;
  inputs.insert(first + 1, again);
  inputs.push_back(again);
  write("frames.jsonl", lines_of(inputs));
  ASSERT_EQ(run(kRun + "frames.jsonl"), 0) << read("err");
  EXPECT_EQ(read("out"), once);
}

TEST_F(Replay, StopsAtARefusedEventAndNamesItsLine) {
  const auto frames = random_frames();
  const auto refusal = [&](const std::string& line) {
    write("frames.jsonl", lines_of(std::vector<Frame>{frames[0], frames[1]}) + line + "\n");
    EXPECT_EQ(run(kRun + "frames.jsonl"), 1);
    EXPECT_EQ(split_lines(read("out")).size(), 2u);
    return read("err");
  };
  const std::string unknown = to_json(event(Event::Kind::kGrasped, 0.1, "cup-9")).dump();
  EXPECT_NE(refusal(unknown).find("frames.jsonl:3: object: "), std::string::npos) << read("err");
  EXPECT_NE(refusal(R"({"event": "stolen", "utime": 1})").find("frames.jsonl:3: event: "),
            std::string::npos)
      << read("err");
}

TEST_F(Replay, A2DWorldTakesPositionsOfTwoNumbers) {
  write("frames.jsonl", lines_of(std::vector<Frame>{random_frames()[0], random_frames()[2]}) +
                            R"({"event": "moved", "object": "cup-1", "utime": )" +
                            std::to_string(at_second(0.2)) + R"(, "position": [5, 1]})" + "\n");
  ASSERT_EQ(run(kRun + "frames.jsonl"), 0) << read("err");
  EXPECT_EQ(json::parse(split_lines(read("out")).back())["objects"][0]["position"],
            json::array({5, 1}));
}

TEST_F(Replay, StandardInput) {
  ASSERT_EQ(run(kRun + "frames.jsonl"), 0);
  const std::string from_file = read("out");
  ASSERT_EQ(run(kRun + "- < frames.jsonl"), 0) << read("err");
  EXPECT_EQ(read("out"), from_file);
}

TEST_F(Replay, EmptyLinesAreSkipped) {
  ASSERT_EQ(run(kRun + "frames.jsonl"), 0);
  const std::string without = read("out");
  write("frames.jsonl", "\n  \r\n" + lines_of(random_frames()) + "\n");
  ASSERT_EQ(run(kRun + "frames.jsonl"), 0);
  EXPECT_EQ(read("out"), without);
}

TEST_F(Replay, AFrameSentAgainIsPassedOver) {
  auto frames = random_frames();
  ASSERT_EQ(run(kRun + "frames.jsonl"), 0);
  const std::string once = read("out");
  frames.insert(frames.begin() + 5, frames[4]);
  frames.push_back(frames[2]);
  write("frames.jsonl", lines_of(frames));
  ASSERT_EQ(run(kRun + "frames.jsonl"), 0) << read("err");
  EXPECT_EQ(read("out"), once);
}

TEST_F(Replay, StopsAtARefusedFrameAndNamesItsLine) {
  auto frames = random_frames();
  std::get<CartesianMeasurement>(frames[7].detections[0].measurement).covariance = {1, 2, 2, 1};
  write("frames.jsonl", lines_of(frames));
  EXPECT_EQ(run(kRun + "frames.jsonl"), 1);
  EXPECT_EQ(split_lines(read("out")).size(), 7u) << "the belief after the frames before it";
  EXPECT_EQ(split_lines(read("err")).size(), 1u);
  EXPECT_NE(read("err").find("frames.jsonl:8: detections[0].covariance: "), std::string::npos)
      << read("err");
}

TEST_F(Replay, StopsAtALineThatIsNoFrame) {
  const auto frames = random_frames();
  write("frames.jsonl", lines_of(std::vector<Frame>{frames[0], frames[1]}) + "\n{\"utime\": 17\n");
  EXPECT_EQ(run(kRun + "frames.jsonl"), 1);
  EXPECT_NE(read("err").find("frames.jsonl:4: "), std::string::npos) << read("err");
  EXPECT_EQ(split_lines(read("err")).size(), 1u);
}

TEST_F(Replay, StopsWhereAnLcmLogIsDamaged) {
  std::ofstream stream(folder_ / "frames.lcm", std::ios::binary);
  LcmLogWriter log(stream);
  for (const Frame& f : random_frames()) ASSERT_TRUE(log.write_frame(f).ok());
  stream.close();
  fs::resize_file(folder_ / "frames.lcm", fs::file_size(folder_ / "frames.lcm") - 3);
  EXPECT_EQ(run(kRun + "frames.lcm"), 1);
  EXPECT_EQ(split_lines(read("out")).size(), random_frames().size() - 1);
  EXPECT_NE(read("err").find("frames.lcm: event"), std::string::npos) << read("err");
}

TEST_F(Replay, AWrongConfigurationGetsALineForEveryMistake) {
  write("world.json",
        R"({"world": {"dimensions": 4, "bounds": {"min": [0, 0, 0], "max": [6, 4, 3]}},
    "sensors": {"default": {"clutter_density": -1, "vieuw": {}}}})");
  EXPECT_EQ(run(kRun + "frames.jsonl"), 2);
  EXPECT_EQ(read("out"), "");
  const auto mistakes = split_lines(read("err"));
  const auto says = [&](const std::string& text) {
    return std::count_if(mistakes.begin(), mistakes.end(), [&](const std::string& line) {
      return line.find(text) != std::string::npos;
    });
  };
  for (const char* path :
       {"world.json: world.dimensions: ", "world.json: sensors.default.clutter_density: ",
        "world.json: sensors.default.vieuw: "})
    EXPECT_EQ(says(path), 1) << path << "\n" << read("err");
  EXPECT_EQ(mistakes.size(), 3u) << read("err");
}

TEST_F(Replay, AWrongCallIsTwoAndAMissingInputOne) {
  EXPECT_EQ(run("--input frames.jsonl"), 2);
  EXPECT_EQ(run("--config world.json"), 2);
  EXPECT_EQ(run(kRun + "frames.jsonl --what"), 2);
  EXPECT_EQ(run(kRun + "frames.jsonl --hypotheses -1"), 2);
  EXPECT_EQ(run("--config missing.json --input frames.jsonl"), 2);
  EXPECT_NE(read("err").find("missing.json"), std::string::npos);
  EXPECT_EQ(run(kRun + "missing.jsonl"), 1);
  EXPECT_NE(read("err").find("missing.jsonl"), std::string::npos);
  EXPECT_EQ(run(kRun + "frames.jsonl --output no/such/folder"), 1);
  EXPECT_EQ(run("--help"), 0);
}

TEST_F(Replay, Statistics) {
  ASSERT_EQ(run(kRun + "frames.jsonl --stats stats.json"), 0);
  const json stats = json::parse(read("stats.json"));
  const auto frames = random_frames();
  std::size_t detections = 0;
  for (const Frame& f : frames) detections += f.detections.size();
  EXPECT_EQ(stats["frames"], frames.size());
  EXPECT_EQ(stats["detections"], detections);
  const json& took = stats["update_ms"];
  EXPECT_GT(took["median"], 0);
  EXPECT_LE(took["median"], took["p99"]);
  EXPECT_LE(took["p99"], took["max"]);
  EXPECT_LE(took["mean"], took["max"]);
  EXPECT_GT(stats["peak_rss_mb"], 0);
  EXPECT_EQ(stats["objects"], json::parse(split_lines(read("out")).back())["objects"].size());
}

TEST_F(Replay, StatisticsOfNothing) {
  write("frames.jsonl", "");
  ASSERT_EQ(run(kRun + "frames.jsonl --stats stats.json"), 0);
  EXPECT_EQ(read("out"), "");
  EXPECT_EQ(json::parse(read("stats.json"))["frames"], 0);
}

TEST_F(Replay, OptionsSayWhatALineHolds) {
  const auto last = [&](const std::string& options) {
    EXPECT_EQ(run("--config world.json --input frames.jsonl " + options), 0) << read("err");
    return json::parse(split_lines(read("out")).back());
  };
  const json plain = last("");
  EXPECT_GE(plain["elapsed_us"], 0);
  EXPECT_FALSE(plain.contains("cluster_hypotheses"));
  EXPECT_FALSE(plain["objects"][0].contains("marginal"));
  EXPECT_FALSE(last("--no-timing").contains("elapsed_us"));
  const json all = last("--all");
  EXPECT_GE(all["objects"].size(), plain["objects"].size());
  for (const json& object : all["objects"]) {
    EXPECT_TRUE(object.contains("in_best"));
    EXPECT_TRUE(object["marginal"].contains("covariance"));
  }
  const json best = last("--hypotheses 2");
  EXPECT_EQ(best["cluster_hypotheses"].size(), best["clusters"]);
  for (const json& cluster : best["cluster_hypotheses"]) {
    EXPECT_GE(cluster.size(), 1u);
    EXPECT_LE(cluster.size(), 2u);
  }
}

TEST_F(Replay, TheDefaultConfigurationTakesFramesOfItsSensors) {
  Frame f = frame(0, {});
  f.detections.resize(1);
  f.detections[0].measurement = CartesianMeasurement{{1, 1, 1}, {.01, 0, 0, 0, .01, 0, 0, 0, .01}};
  write("frames.jsonl", lines_of(std::vector<Frame>{f}));
  EXPECT_EQ(run("--config '" ANCHORD_SOURCE_DIR "/config/home.json' --input frames.jsonl"), 0)
      << read("err");
}

}  // namespace
}  // namespace anchord
