// anchord: the daemon. Detections come in over LCM and HTTP, the belief goes out.

#include <malloc.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <exception>
#include <string_view>
#include <thread>

#include "daemon/installed_files.h"
#include "daemon/lcm_child.h"
#include "daemon/service.h"
#include "knowledge/configuration.h"

namespace {

constexpr int kFailed = 1, kWrongCall = 2;

int fail(const std::string& message) {
  std::fprintf(stderr, "anchord: %s\n", message.c_str());
  return kFailed;
}

/// A checkpoint takes a dozen megabytes for a moment. malloc puts such blocks among the others once
/// it has seen some of them freed, and does not get them back if anything comes to lie behind; on
/// pages of their own they go when they are freed.
void give_large_blocks_back() {
  mallopt(M_MMAP_THRESHOLD, 4 << 20);
  mallopt(M_TRIM_THRESHOLD, 16 << 20);  // else this would be 128 KiB from now on
}

/// Waits for SIGTERM or SIGINT, which every thread must have blocked.
void await_end(const sigset_t& signals) {
  int signal = 0;
  sigwait(&signals, &signal);
}

/// Serves until a signal ends it; the belief is restored meanwhile, so that one ends that too.
int serve(const anchord::Knowledge& knowledge, const anchord::ServiceOptions& options) {
  give_large_blocks_back();
  // Before any thread is started, so that all of them inherit it.
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::signal(SIGPIPE, SIG_IGN);

  auto service = anchord::Service::open(knowledge, options);
  if (!service) {
    fail(service.error().text());
    return service.error().code == anchord::ErrorCode::kInvalid ? kWrongCall : kFailed;
  }
  std::atomic<bool> cancelled{false};
  anchord::Status started = anchord::Done{};
  std::thread starter([&] {
    try {
      started = (*service)->start(cancelled);
    } catch (const std::exception& error) {
      started = anchord::Error{anchord::ErrorCode::kIo, "", error.what()};
    }
    if (!started) kill(getpid(), SIGTERM);
  });
  await_end(signals);
  cancelled = true;
  starter.join();
  if (!started) return fail(started.error().text());
  spdlog::info("ends");
  (*service)->stop();
  return 0;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc == 3 && std::string_view(argv[1]) == anchord::kReceiveLcm)  // only ever by itself
    return anchord::receive_lcm(argv[2]);
  CLI::App app{"The semantic world model of a robot: detections in, beliefs out."};
  const anchord::InstalledFiles installed = anchord::installed_files();
  std::string config = installed.configuration;
  anchord::ServiceOptions options;
  options.viewer = installed.viewer;
  app.add_option("--config", config, "configuration of the world")->capture_default_str();
  app.add_option("--data", options.data_directory, "directory of the frame log")
      ->capture_default_str();
  app.add_option("--lcm", options.lcm_url, "LCM URL; default: LCM's own with ttl 0");
  app.add_option("--http", options.http_address,
                 "ADDR:PORT to serve on; only loopback without --token-file")
      ->capture_default_str();
  app.add_option("--token-file", options.token_file,
                 "file with the token that requests must bear, for its owner alone (mode 600)");
  app.add_option("--viewer", options.viewer,
                 "folder of the pages that are served, read at the start; '': none")
      ->capture_default_str();
  app.add_option("--checkpoint-interval", options.checkpoint_interval,
                 "seconds of work on frames between checkpoints, which a start does again; 0: one "
                 "after each batch")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.set_version_flag("--version", ANCHORD_VERSION);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kWrongCall;
  }
  spdlog::set_default_logger(spdlog::stderr_color_mt("anchord"));

  const auto configuration = anchord::read_configuration(config);
  if (!configuration.ok()) {
    for (const auto& mistake : configuration.mistakes())
      std::fprintf(stderr, "%s: %s\n", config.c_str(), mistake.text().c_str());
    return kWrongCall;
  }

  return serve(configuration.knowledge(), options);
} catch (const std::exception& error) {
  return fail(error.what());
}
