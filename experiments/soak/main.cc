// soak_home: a simulated home and what its sensors report, as lines of JSON (lines.h), until
// nobody reads them any more.

#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdio>
#include <string>

#include "experiments/soak/lines.h"
#include "knowledge/configuration.h"

int main(int argc, char** argv) {
  CLI::App app{"A simulated home and what its sensors report, as lines of JSON."};
  std::string file;
  std::uint64_t seed = 1;
  double seconds = 0;
  app.add_option("--config", file, "what is known of the home")->required();
  app.add_option("--seed", seed)->capture_default_str();
  app.add_option("--seconds", seconds, "of the home's time; 0: without end")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  const auto configuration = anchord::read_configuration(file);
  if (!configuration.ok()) {
    for (const auto& mistake : configuration.mistakes())
      std::fprintf(stderr, "%s\n", mistake.text().c_str());
    return 2;
  }
  anchord::experiment::HomeLines lines(configuration.knowledge(), seed);
  std::puts(lines.header().c_str());
  for (std::int64_t quarter = 0; seconds == 0 || static_cast<double>(quarter) < 4 * seconds;
       ++quarter)
    for (const std::string& line : lines.next())
      if (std::puts(line.c_str()) < 0) return 0;
  return 0;
}
