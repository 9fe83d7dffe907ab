// verification_follow: people on a video, each followed only by verification tasks whose rate the
// expected information gain chooses (thesis section 3.8.1). Writes a line for each person and
// frame.

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <opencv2/core/utils/logger.hpp>
#include <set>

#include "experiments/verification/follower.h"
#include "experiments/verification/truth.h"
#include "knowledge/configuration.h"
#include "perception/camera_file.h"
#include "tools/anchor_detect/video.h"

namespace anchord {
namespace {

constexpr int kFailed = 1, kWrongCall = 2;
constexpr Utime kStart = 1'700'000'000'000'000;

struct Options {
  std::string video, camera = "config/plaza.camera.json", config = "config/plaza.json";
  std::string truth, output;
  std::vector<double> from;  ///< first frame, x, y, last frame
  std::vector<int> people;
  double threshold = 1, fps = 7, learn_s = 40;
};

struct Followed {
  int name = 0;
  std::map<int, Eigen::Vector2d> truth;  ///< by frame; the first is where she is said to stand
  int last = 0;                          ///< frame
  std::unique_ptr<Follower> follower;
  bool started = false, over = false;
};

int fail(const std::string& text) {
  std::fprintf(stderr, "verification_follow: %s\n", text.c_str());
  return kFailed;
}

void write(std::ostream& out, const Followed& person, int frame, const Step& step) {
  static constexpr const char* kSights[] = {"found", "absent", "hidden", "doubtful"};
  const char* outcome =
      step.looked ? kSights[static_cast<std::size_t>(step.sighting.sight)] : "none";
  out << person.name << ',' << frame << ',' << seconds_between(kStart, step.utime) << ','
      << step.entropy_before << ',' << step.entropy_after << ',' << step.gain << ','
      << (step.looked ? 1 : 0) << ',' << outcome << ',' << step.sighting.looked_at << ','
      << step.sighting.visible << ',' << step.position.x() << ',' << step.position.y() << ',';
  const auto truth = person.truth.find(frame);
  if (truth != person.truth.end())
    out << truth->second.x() << ',' << truth->second.y();
  else
    out << ',';
  out << ',' << step.look_ms << '\n';
}

/// Who shall be followed: those of the truth, or one from a place that was told.
Result<std::vector<Followed>> whom(const Options& options) {
  std::vector<Followed> people;
  if (options.truth.empty()) {
    const int frame = static_cast<int>(options.from[0]);
    people.push_back(
        {1, {{frame, {options.from[1], options.from[2]}}}, static_cast<int>(options.from[3]), {}});
    return people;
  }
  auto truth = read_truth(options.truth);
  if (!truth) return truth.error();
  const std::set<int> wanted(options.people.begin(), options.people.end());
  for (auto& [name, track] : *truth) {
    if (!wanted.empty() && wanted.count(name) == 0) continue;
    const int last = track.rbegin()->first;
    people.push_back({name, std::move(track), last, {}});
  }
  return people;
}

void follow(Followed& person, const CameraPicture& picture, int frame, Utime utime,
            std::ostream& out) {
  if (person.over || frame < person.truth.begin()->first) return;
  person.over = frame > person.last;
  if (person.over) return;
  if (!person.started) {
    const auto at = person.truth.find(frame);
    person.started = at != person.truth.end() && person.follower->start(picture, utime, at->second);
    return;
  }
  write(out, person, frame, person.follower->step(picture, utime));
  person.over = person.follower->missing();
}

int run(const Options& options) {
  ConfigurationMistakes mistakes;
  const auto camera = read_camera_file(options.camera, mistakes);
  const Configuration configuration = read_configuration(options.config);
  if (!camera || !configuration.ok()) {
    std::fprintf(stderr, "verification_follow: the camera's file or configuration is wrong\n");
    return kWrongCall;
  }
  auto people = whom(options);
  if (!people) return fail(people.error().text());
  Video::Settings settings;
  settings.input = options.video;
  settings.size = {camera->camera.width, camera->camera.height};
  settings.fps = options.fps;
  settings.start_utime = kStart;
  auto video = Video::open(settings);
  if (!video) return fail(video.error().text());
  const std::vector<cv::Mat> scene = video->learn(options.learn_s);
  if (scene.empty()) return fail("the video holds no picture");
  const Verifier verifier(*camera, scene, configuration.knowledge().dims);
  for (Followed& person : *people) {
    person.follower = std::make_unique<Follower>(configuration.knowledge(), verifier,
                                                 options.threshold, camera->verification.looks);
  }
  std::ofstream out(options.output);
  out << "person,frame,time,entropy_before,entropy_after,gain,looked,outcome,looked_at,visible,x,y,"
         "true_x,true_y,look_ms\n";
  for (int frame = 1; auto picture = video->next(); ++frame) {
    for (Followed& person : *people) {
      follow(person, {picture->picture, {}}, frame, picture->utime, out);
    }
  }
  for (const Followed& person : *people) {
    if (!person.started) std::fprintf(stderr, "%d was not found where she stands\n", person.name);
  }
  out.close();
  return out ? 0 : fail(options.output + " cannot be written");
}

}  // namespace
}  // namespace anchord

int main(int argc, char** argv) {
  CLI::App app{"Follows people on a video by verification tasks alone."};
  anchord::Options options;
  app.add_option("video", options.video, "the video")->required();
  app.add_option("--output", options.output, "the table to write, CSV")->required();
  app.add_option("--camera", options.camera, "the camera's file")->capture_default_str();
  app.add_option("--config", options.config, "the engine's configuration")->capture_default_str();
  app.add_option("--threshold", options.threshold, "least expected gain of a look, nat")
      ->capture_default_str();
  app.add_option("--fps", options.fps, "frames per second")->capture_default_str();
  auto* from =
      app.add_option("--from", options.from, "first frame, x and y of the person there, last frame")
          ->expected(4);
  auto* truth = app.add_option("--truth", options.truth, "frame,id,x,y: follows everybody in it");
  app.add_option("--person", options.people, "only these of the truth")->needs(truth);
  try {
    app.parse(argc, argv);
    if ((from->count() > 0) == (truth->count() > 0))
      throw CLI::RequiredError("one of --from, --truth");
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : anchord::kWrongCall;
  }
  try {
    cv::setNumThreads(1);
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    return anchord::run(options);
  } catch (const std::exception& error) {
    return anchord::fail(error.what());
  }
}
