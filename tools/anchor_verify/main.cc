// anchor-verify: looks for what the daemon's verification tasks ask for, in the pictures of one
// camera, fixed or carried by a robot, and only where the tasks say.

#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <string>

#include "answers.h"
#include "image_inbox.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/verification_codec.h"
#include "task_list.h"
#include "tools/anchor_detect/video_program.h"

namespace anchord {
namespace {

constexpr const char* kProgram = "anchor-verify";
constexpr int kPollMs = 100;
constexpr std::size_t kLearnt = 56;  ///< pictures whose median is the empty scene

using Clock = std::chrono::steady_clock;

struct Options {
  std::string camera_file = "config/plaza.camera.json";
  std::string lcm_url, robot, sensor;
  Video::Settings video;  ///< no input: images over LCM
  double learn_s = 40;
  bool learn_given = false;
  int dims = 2;
};

/// SIGTERM and SIGINT, which every thread has blocked, so that they wait to be asked for.
class EndSignal {
 public:
  EndSignal() {
    sigemptyset(&signals_);
    sigaddset(&signals_, SIGTERM);
    sigaddset(&signals_, SIGINT);
    pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  }
  /// Whether one comes within that time.
  bool within(Clock::duration time) const {
    const auto ns =
        std::max<std::int64_t>(0, std::chrono::nanoseconds(time).count());  // late: at once
    const timespec wait{ns / 1'000'000'000, ns % 1'000'000'000};
    return sigtimedwait(&signals_, nullptr, &wait) > 0;
  }

 private:
  sigset_t signals_;
};

void say(const Error& error, const char* what) {
  std::fprintf(stderr, "%s: refused %s: %s\n", kProgram, what, error.text().c_str());
}

void listen(LcmBus& bus, TaskList& tasks) {
  const Status done = bus.subscribe(kTaskChannel, [&](std::span<const std::uint8_t> bytes) {
    const auto message = decode_task(bytes);
    if (!message) return say(message.error(), "a task");
    if (const Status taken = tasks.add(message->task); !taken) say(taken.error(), "a task");
  });
  if (!done) throw std::runtime_error(done.error().text());
}

void listen(LcmBus& bus, ImageInbox& inbox) {
  const Status done = bus.subscribe(kImageChannel, [&](std::span<const std::uint8_t> bytes) {
    const auto image = decode_image(bytes);
    if (!image) return say(image.error(), "an image");
    if (const Status taken = inbox.add(*image); !taken) say(taken.error(), "an image");
  });
  if (!done) throw std::runtime_error(done.error().text());
}

/// A video's pictures at their own pace, until its end.
Status play(Video& video, const EndSignal& end, Answers& answers) {
  const Clock::time_point started = Clock::now();
  Utime first = 0;
  while (auto frame = video.next()) {
    if (first == 0) first = frame->utime;
    const auto due = started + std::chrono::microseconds(frame->utime - first);
    if (end.within(video.live() ? Clock::duration::zero() : due - Clock::now())) break;
    if (Status done = answers.look({{frame->picture, {}}, frame->utime}); !done) return done;
  }
  return Done{};
}

/// Pictures from LCM to learn the empty scene from, evenly over `seconds` of their own time.
std::vector<cv::Mat> learn(ImageInbox& inbox, double seconds, const EndSignal& end) {
  std::vector<cv::Mat> pictures;
  Utime first = 0;
  while (!end.within(Clock::duration::zero())) {
    const auto next = inbox.wait(kPollMs);
    if (!next) continue;
    if (first == 0) first = next->utime;
    const double passed = seconds_between(first, next->utime);
    if (passed >= seconds * static_cast<double>(pictures.size()) / kLearnt) {
      pictures.push_back(next->picture.frame);
    }
    if (pictures.size() >= kLearnt || passed >= seconds) break;
  }
  return pictures;
}

Status serve(ImageInbox& inbox, const EndSignal& end, Answers& answers) {
  while (!end.within(Clock::duration::zero())) {
    const auto picture = inbox.wait(kPollMs);
    if (!picture) continue;
    if (Status done = answers.look(*picture); !done) return done;
  }
  return Done{};
}

int run(Options options) {
  const EndSignal end;  // before there are threads
  const auto settings = camera_settings(kProgram, options.camera_file);
  if (!settings) return kWrongCall;
  if (settings->camera.carried) {
    if (!options.video.input.empty()) {
      return refuse_option(kProgram, invalid("--video", "has no poses, and the camera is carried"));
    }
    if (options.learn_given && options.learn_s > 0) {
      return refuse_option(kProgram,
                           invalid("--learn", "needs a camera that stands still; 0 says so"));
    }
    options.learn_s = 0;
  }
  if (options.sensor.empty()) options.sensor = settings->sensor;

  std::optional<Video> video;
  if (!options.video.input.empty()) {
    options.video.size = {settings->camera.width, settings->camera.height};
    auto opened = Video::open(options.video);
    if (!opened) return fail(kProgram, opened.error());
    video = std::move(*opened);
  }
  TaskList tasks(options.robot, options.sensor, options.dims, settings->verification.looks);
  ImageInbox inbox(options.robot, options.sensor, settings->camera);
  auto bus = LcmBus::open(options.lcm_url);  // after what its thread calls, so that it ends before
  if (!bus) return fail(kProgram, bus.error());
  listen(**bus, tasks);
  if (!video) listen(**bus, inbox);
  (*bus)->start();

  std::vector<cv::Mat> scene;
  if (options.learn_s > 0) {
    scene = video ? video->learn(options.learn_s) : learn(inbox, options.learn_s, end);
  }
  Verifier verifier(*settings, scene, options.dims);
  scene.clear();
  Answers answers(options.robot, options.sensor, tasks, verifier, **bus);
  const Status done = video ? play(*video, end, answers) : serve(inbox, end, answers);
  (*bus)->stop();
  if (!done) return fail(kProgram, done.error());
  const Answers::Totals& t = answers.totals();
  const double looks = std::max<double>(1, static_cast<double>(t.looks));
  std::fprintf(stderr,
               "%zu looks in %zu pictures: %zu found, %zu missing, %zu occluded; %.2f %% of the "
               "picture and %.1f ms per look\n",
               t.looks, t.pictures, t.found, t.missing, t.occluded, 100 * t.looked_at / looks,
               1e3 * t.seconds / looks);
  return 0;
}

}  // namespace
}  // namespace anchord

int main(int argc, char** argv) {
  CLI::App app{
      "Looks for the objects of verification tasks in the pictures of a camera, fixed or carried."};
  anchord::Options options;
  anchord::add_camera_option(app, options.camera_file);
  app.add_option("--video", options.video.input,
                 "a video file, or a camera's number; default: images over LCM");
  anchord::add_video_options(app, options.video);
  const auto* learn =
      app.add_option("--learn", options.learn_s,
                     "seconds from which the empty scene is learnt; 0: people are not looked for, "
                     "as always by a carried camera")
          ->check(CLI::Range(0.0, 3600.0))
          ->capture_default_str();
  app.add_option("--dimensions", options.dims, "of the world: 2 or 3")
      ->check(CLI::IsMember({2, 3}))
      ->capture_default_str();
  app.add_option("--robot", options.robot, "whose camera it is; default: the only one's");
  app.add_option("--sensor", options.sensor,
                 "the sensor's name in the tasks; default: the camera file's");
  app.add_option("--lcm", options.lcm_url, "LCM URL; default: LCM's own with ttl 0");
  return anchord::run_program(anchord::kProgram, app, argc, argv, [&] {
    options.learn_given = learn->count() > 0;
    return anchord::run(options);
  });
}
