// The experiments of thesis section 2.6 and beyond: one line per frame or run, CSV, on standard
// output.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <functional>
#include <map>
#include <string>

#include "experiments/anchoring/ants.h"
#include "experiments/anchoring/boxes.h"
#include "experiments/anchoring/cups.h"
#include "experiments/anchoring/hidden.h"
#include "knowledge/configuration.h"

namespace anchord::experiment {
namespace {

struct Options {
  std::string study, config, variant;
  int seeds = 30;
  double longest = 60;  ///< s, of the ambiguities of `hidden`
};

template <typename Numbers>
void print_list(const Numbers& numbers) {
  const char* between = "";
  for (const auto number : numbers) {
    std::printf("%s%lld", between, static_cast<long long>(number));
    between = " ";
  }
}

void boxes(const Knowledge& knowledge, const Options& options) {
  std::printf("variant,seed,time,part,one_blob,detections,truth,shown,one_large,names\n");
  const auto report =
      knowledge.find_attribute("ratio") >= 0 ? BlobReport::kNumbers : BlobReport::kSymbols;
  for (int seed = 1; seed <= options.seeds; ++seed) {
    Dice dice(static_cast<std::uint64_t>(seed));
    const auto shots = simulate_boxes(report, dice);
    const auto beliefs = watch_boxes(knowledge, shots);
    for (std::size_t k = 0; k < shots.size(); ++k) {
      const BoxesShot& shot = shots[k];
      std::printf("%s,%d,%.2f,%s,%d,%zu,%d,%d,%.6f,", options.variant.c_str(), seed, shot.time,
                  shot.part.c_str(), shot.one_blob, shot.frame.detections.size(),
                  shot.truth[kRightBox] ? 4 : 3, beliefs[k].shown, beliefs[k].one_large);
      print_list(beliefs[k].names);
      std::printf("\n");
    }
  }
}

void ants(const Knowledge& knowledge, const Options& options) {
  std::printf("variant,seed,time,detections,truth,expected,shown,names\n");
  for (int seed = 1; seed <= options.seeds; ++seed) {
    Dice dice(static_cast<std::uint64_t>(seed));
    const auto shots = simulate_ants({}, dice);
    const auto beliefs = watch_ants(knowledge, shots);
    for (std::size_t k = 0; k < shots.size(); ++k) {
      std::printf("%s,%d,%.2f,%zu,%zu,%.4f,%d,", options.variant.c_str(), seed, shots[k].time,
                  shots[k].frame.detections.size(), shots[k].truth.size(), beliefs[k].expected,
                  beliefs[k].shown);
      print_list(beliefs[k].names);
      std::printf("\n");
    }
  }
}

void cups(const Knowledge& knowledge, const Options& options) {
  std::printf("variant,seed,time,part,moved,new,one_cup,two_cups\n");
  for (int seed = 1; seed <= options.seeds; ++seed) {
    Dice dice(static_cast<std::uint64_t>(seed));
    const auto shots = simulate_cups(dice);
    const auto beliefs = watch_cups(knowledge, shots);
    for (std::size_t k = 0; k < shots.size(); ++k)
      std::printf("%s,%d,%.2f,%s,%.6f,%.6f,%d,%d\n", options.variant.c_str(), seed, shots[k].time,
                  shots[k].part.c_str(), beliefs[k].moved, beliefs[k].new_cup, beliefs[k].one_cup,
                  beliefs[k].two_cups);
  }
}

void hidden(const Knowledge& knowledge, const Options& options) {
  const std::pair<Ambiguity, const char*> ambiguities[]{{Ambiguity::kHidden, "both hidden"},
                                                        {Ambiguity::kOneInSight, "one in sight"},
                                                        {Ambiguity::kNoColor, "no color"},
                                                        {Ambiguity::kSideBySide, "side by side"}};
  std::printf("variant,ambiguity,false_positives,seconds,seed,right,probability,kept\n");
  for (const auto& [ambiguity, name] : ambiguities)
    for (const double false_positives : {0.0, 0.5})
      for (const double seconds : {0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 60.0})
        for (int seed = 1; seed <= options.seeds && seconds <= options.longest; ++seed) {
          Dice dice(static_cast<std::uint64_t>(seed));
          const HiddenOutcome o =
              watch_hidden(knowledge, simulate_hidden({ambiguity, seconds, false_positives}, dice));
          std::printf("%s,%s,%g,%g,%d,%d,%.6f,%.6f\n", options.variant.c_str(), name,
                      false_positives, seconds, seed, o.right, o.probability, o.kept);
          std::fflush(stdout);
        }
}

const std::map<std::string, std::function<void(const Knowledge&, const Options&)>> kStudies{
    {"boxes", boxes}, {"ants", ants}, {"cups", cups}, {"hidden", hidden}};

int run(const Options& options) {
  const Configuration configuration = read_configuration(options.config);
  for (const auto& mistake : configuration.mistakes())
    std::fprintf(stderr, "%s: %s\n", options.config.c_str(), mistake.text().c_str());
  if (!configuration.ok()) return 2;
  kStudies.at(options.study)(configuration.knowledge(), options);
  return 0;
}

}  // namespace
}  // namespace anchord::experiment

int main(int argc, char** argv) {
  using anchord::experiment::kStudies;
  CLI::App app{"Simulations of anchoring: one line of CSV per frame or run"};
  anchord::experiment::Options options;
  app.add_option("study", options.study, "which")->required()->check(CLI::IsMember(kStudies));
  app.add_option("config", options.config, "the engine's configuration")->required();
  app.add_option("--variant", options.variant, "what the lines are called");
  app.add_option("--seeds", options.seeds, "how many")->check(CLI::PositiveNumber);
  app.add_option("--longest", options.longest, "leave out ambiguities of more seconds");
  CLI11_PARSE(app, argc, argv);
  return anchord::experiment::run(options);
}
