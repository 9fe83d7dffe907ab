// Writes the seed corpora of the fuzz targets, encoded for real: fuzz_seeds CORPUS_DIRECTORY

#include <anchord/query_t.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "api/frame_json.h"
#include "api/lcm_log.h"
#include "lcmtypes/codec.h"
#include "lcmtypes/event_codec.h"
#include "lcmtypes/image_codec.h"
#include "lcmtypes/verification_codec.h"
#include "tests/lcmtypes/sample_frames.h"
#include "tests/lcmtypes/sample_verification.h"

namespace anchord {
namespace {

/// Small frames that between them use every field.
std::vector<std::pair<std::string, Frame>> frames() {
  const Frame full = testing::full_frame();
  Frame empty;
  empty.utime = full.utime;
  empty.sensor = "s";
  Frame posed = full;
  posed.detections.clear();
  posed.view.reset();
  Frame detected = full;
  detected.pose.reset();
  detected.view->type = View::Type::kPolygon;
  detected.view->points = {{0, 0}, {2, 0}, {0, 2}};
  Frame frustum = empty;
  frustum.view = View{};
  frustum.view->type = View::Type::kFrustum;
  frustum.view->range = {0.5, 4};
  frustum.view->hfov = 1;
  frustum.view->vfov = 0.75;
  return {{"empty", empty}, {"posed", posed}, {"detected", detected}, {"frustum", frustum}};
}

template <typename Bytes>
void write(const std::filesystem::path& path, const Bytes& bytes) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream stream(path, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  if (!stream) throw std::runtime_error("cannot write " + path.string());
}

void write_verification(const std::filesystem::path& folder) {
  Event missing;
  missing.kind = Event::Kind::kMissing;
  missing.regions = testing::two_regions();
  write(folder / "event", encode(testing::full_event(), 1));
  write(folder / "event_missing", encode(missing, 0));
  write(folder / "trigger", encode(testing::full_trigger()));
  write(folder / "trigger_cancelling", encode(testing::cancelling()));
  write(folder / "task", encode(testing::full_task()));
  write(folder / "task_empty", encode(TaskMessage{}));
  VerificationResult found = testing::full_result();
  found.frame->detections.resize(1);
  write(folder / "result_found", encode(found));
  write(folder / "result_missing", encode(testing::missing_result()));
  write(folder / "pose", encode(testing::full_pose()));
  ImageMessage image = testing::full_image();
  write(folder / "image_bgr", encode(image));
  image.format = ImageMessage::Format::kJpeg;
  image.data.resize(2);
  write(folder / "image_jpeg", encode(image));
}

void write_all(const std::filesystem::path& root) {
  nlohmann::json array = nlohmann::json::array();
  std::ostringstream log;
  LcmLogWriter writer(log);
  for (const auto& [name, frame] : frames()) {
    write(root / "frame_lcm" / name, encode(frame, 1));
    write(root / "frame_json" / name, to_json(frame).dump());
    if (name == "posed") continue;  // 36 numbers once are enough
    array.push_back(to_json(frame));
    if (!writer.write_frame(frame)) throw std::runtime_error("cannot write a log");
    if (!writer.write("OTHER", 1, {})) throw std::runtime_error("cannot write a log");
  }
  Frame repeated = testing::full_frame();  // refused: an attribute is there twice
  repeated.detections.resize(1);
  repeated.detections[0].attributes[1].name = repeated.detections[0].attributes[0].name;
  write(root / "frame_lcm" / "repeated", encode(repeated, 1));
  write(root / "frame_json" / "array", array.dump());
  write(root / "lcm_log" / "frames", log.str());
  write_verification(root / "verification");
  for (const std::string target : {"/v1/status", "/v1/where?class=cup&color=blue"}) {
    query_t query{};
    query.id = 1;
    query.target = target;
    write(root / "query_lcm" / std::to_string(target.size()), encode_message(query));
  }
}

}  // namespace
}  // namespace anchord

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: fuzz_seeds CORPUS_DIRECTORY\n");
    return 2;
  }
  try {
    anchord::write_all(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fuzz_seeds: %s\n", error.what());
    return 1;
  }
  return 0;
}
