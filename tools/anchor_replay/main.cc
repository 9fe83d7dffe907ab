// anchor-replay: the engine without network or database. Frames and events in, the belief after
// each out.

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iostream>

#include "knowledge/configuration.h"
#include "tools/anchor_replay/replay.h"

namespace {

constexpr int kFailed = 1, kWrongCall = 2;

int fail(int status, const std::string& message) {
  std::fprintf(stderr, "anchor-replay: %s\n", message.c_str());
  return status;
}

using anchord::read_configuration;

/// The configuration with which an exported log begins.
anchord::Configuration configuration_in(anchord::FrameSource& source) {
  const auto first = source.next_item();
  if (!first) return anchord::ConfigurationMistakes{{"", first.error().text()}};
  const auto* note = *first ? std::get_if<anchord::ReplayNote>(&**first) : nullptr;
  if (!note || note->configuration.empty())
    return anchord::ConfigurationMistakes{
        {"", "begins with no configuration, as an exported log does: give one with --config"}};
  return anchord::parse_configuration(note->configuration);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Folds recorded frames into the belief. Same input, same output, to the byte."};
  std::string config, input, output = "-", stats;
  bool no_timing = false, quiet = false;
  anchord::ReplayOptions options;
  app.add_option(
      "--config", config,
      "configuration of the world; an exported log has its own, which hold without this");
  app.add_option("--input", input,
                 "frames and events: JSON lines, an LCM log (.lcm, .lcmlog), or -")
      ->required();
  app.add_option("--output", output, "belief after each of them, JSON lines; - is standard output")
      ->capture_default_str();
  app.add_option("--stats", stats, "write what it took, as JSON");
  app.add_flag("--all", options.line.all, "every anchor of p >= 0.001, not only the best world");
  app.add_option("--hypotheses", options.line.hypotheses,
                 "the N best hypotheses of each cluster with each line")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--work", options.work,
                 "bound on the work of each frame: versions carried, anchors of hypotheses");
  app.add_flag("--no-timing", no_timing, "leave elapsed_us out: equal runs give equal bytes");
  app.add_flag("--no-output", quiet, "write no belief, only fold");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kWrongCall;
  }
  options.timing = !no_timing;

  options.own_configuration = !config.empty();
  auto source = anchord::FrameSource::open(input, 3);
  if (!source) return fail(kFailed, source.error().text());
  auto configuration = config.empty() ? configuration_in(**source) : read_configuration(config);
  if (!configuration.ok()) {
    for (const auto& mistake : configuration.mistakes())
      std::fprintf(stderr, "%s: %s\n", (config.empty() ? input : config).c_str(),
                   mistake.text().c_str());
    return kWrongCall;
  }
  (*source)->set_dims(configuration.knowledge().dims);
  std::ofstream file;
  std::ostream* out = quiet ? nullptr : &std::cout;
  if (!quiet && output != "-") {
    file.open(output);
    if (!file) return fail(kFailed, output + " cannot be written");
    out = &file;
  }
  std::ios::sync_with_stdio(false);

  anchord::World world(configuration.knowledge());
  const auto seconds = [] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
  };
  const auto statistics = anchord::replay(world, **source, out, options, seconds);
  if (out && !out->flush() && statistics) return fail(kFailed, output + " cannot be written");
  if (!statistics) return fail(kFailed, statistics.error().text());
  if (!stats.empty()) {
    std::ofstream to(stats);
    to << statistics->json().dump() << '\n';
    if (!to) return fail(kFailed, stats + " cannot be written");
  }
  return 0;
}
