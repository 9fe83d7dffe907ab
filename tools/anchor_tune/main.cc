// anchor-tune: the numbers of a configuration from recorded frames, with truth or alone, each with
// a comment on where it came from.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>

#include "knowledge/configuration_file.h"
#include "tools/anchor_tune/from_frames.h"
#include "tools/anchor_tune/from_truth.h"

namespace {

using namespace anchord;

constexpr int kFailed = 1, kWrongCall = 2;

int fail(int status, const std::string& message) {
  std::fprintf(stderr, "anchor-tune: %s\n", message.c_str());
  return status;
}

int refuse(const std::string& file, const ConfigurationMistakes& mistakes) {
  for (const auto& mistake : mistakes)
    std::fprintf(stderr, "%s: %s\n", file.c_str(), mistake.text().c_str());
  return kWrongCall;
}

struct Call {
  std::string config, output;
  std::vector<std::string> inputs, truths, indices;
  tuning::TruthOptions truth;
  int evaluations = 600;
};

Result<std::vector<tuning::Recording>> read(const Call& call, int dims) {
  std::vector<tuning::Recording> recordings;
  for (std::size_t i = 0; i < call.inputs.size(); ++i) {
    tuning::Recording& recording = recordings.emplace_back();
    auto frames = tuning::read_frames(call.inputs[i], dims);
    if (!frames) return frames.error();
    recording.frames = *std::move(frames);
    if (call.truths.empty()) continue;
    auto truth = tuning::read_truth(call.truths[i], call.indices[i]);
    if (!truth) return truth.error();
    recording.truth = *std::move(truth);
  }
  return recordings;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Estimates the numbers of a configuration, with 95 % intervals, from frames with truth or "
      "from frames alone, and writes the configuration with a comment at each."};
  Call call;
  app.add_option("--config", call.config,
                 "configuration that says the structure, and where to start")
      ->required();
  app.add_option("--input", call.inputs,
                 "frames: JSON lines, an LCM log (.lcm, .lcmlog), or -; repeat for more recordings")
      ->required();
  app.add_option("--truth", call.truths, "CSV frame,id,x,y[,z][,class][,ignore], one per input");
  app.add_option("--index", call.indices, "CSV utime,frame, one per truth");
  app.add_option("--radius", call.truth.radius, "m, between a detection and its object, with truth")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--arrivals", call.truth.gates,
                 "find up to N places where objects of a class come in, with truth")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--evaluations", call.evaluations, "of the evidence, without truth")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--output", call.output, "the tuned configuration")->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kWrongCall;
  }
  if (call.truths.size() != call.indices.size() ||
      (!call.truths.empty() && call.truths.size() != call.inputs.size()))
    return fail(kWrongCall, "every --input needs its --truth and --index, or none has them");

  const auto configuration = read_configuration(call.config);
  if (!configuration.ok()) return refuse(call.config, configuration.mistakes());
  const Knowledge& knowledge = configuration.knowledge();
  ConfigurationMistakes mistakes;
  const auto document = load_document(std::filesystem::path(call.config), mistakes);
  if (!document) return refuse(call.config, mistakes);
  const auto recordings = read(call, knowledge.dims);
  if (!recordings) return fail(kFailed, recordings.error().text());

  const auto findings = call.truths.empty()
                            ? tuning::findings_from_frames(*recordings, knowledge, call.evaluations)
                            : tuning::findings_from_truth(*recordings, knowledge, call.truth);
  if (!findings) return fail(kFailed, findings.error().text());
  const std::string text = tuning::tuned_text(
      *document, *findings,
      "Written by anchor-tune. A number without a comment is as it was; an interval holds the true "
      "value in 95 of 100 cases, as far as the models are right.");
  if (const auto tuned = parse_configuration(text); !tuned.ok())
    return refuse(call.output, tuned.mistakes());
  std::ofstream(call.output) << text;
  if (std::ifstream(call.output).peek() != text[0])
    return fail(kFailed, call.output + " cannot be written");
  std::fputs(tuning::report_text(*findings).c_str(), stdout);
  return 0;
}
