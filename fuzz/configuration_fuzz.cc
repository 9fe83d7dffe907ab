#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "knowledge/configuration.h"

// Any text either becomes knowledge that keeps its promises, or at least one mistake that says
// something; nothing escapes and no file is touched.

namespace {

void require(bool kept, const char* promise) {
  if (kept) return;
  std::fprintf(stderr, "broken: %s\n", promise);
  std::abort();
}

void require_distribution(const std::vector<double>& distribution, const char* promise) {
  double sum = 0;
  for (const double p : distribution) {
    require(p >= 0, promise);
    sum += p;
  }
  require(distribution.empty() || std::abs(sum - 1) < 1e-9, promise);
}

void require_promises(const anchord::Knowledge& knowledge) {
  const int places = static_cast<int>(knowledge.places.size());
  require(!knowledge.classes.empty(), "there is a class");
  require((knowledge.bounds_max - knowledge.bounds_min).head(knowledge.dims).minCoeff() > 0,
          "the world has a volume");
  for (const auto& place : knowledge.places) {
    require(place.parent >= -1 && place.parent < places, "parents exist");
    require(place.depth >= 0 && place.depth < places, "places do not lie in themselves");
    require(place.region.volume(knowledge.dims) > 0, "places have a volume");
  }
  for (const auto& object_class : knowledge.classes) {
    std::vector<double> weights;
    for (const auto& model : object_class.models) {
      weights.push_back(model.initial_weight);
      require(model.place >= -1 && model.place < places, "places of models exist");
    }
    require(!weights.empty(), "classes have models");
    require_distribution(weights, "initial weights sum to 1");
  }
  auto sensors = knowledge.sensors;
  sensors.push_back(knowledge.default_sensor);
  for (const auto& sensor : sensors) {
    require(sensor.clutter_density > 0, "there is clutter");
    require(sensor.detection_probability.size() == knowledge.classes.size(),
            "every class has a detection probability");
    for (const anchord::DetectionProbability& p : sensor.detection_probability)
      for (const double range : {0.0, 1.0, 1e8}) {
        require(p.at(range) >= 0 && p.at(range) < 1, "detection is never certain");
      }
    require(sensor.prior.size() == knowledge.attributes.size(), "every attribute has a prior");
    for (const auto& prior : sensor.prior) require_distribution(prior, "priors sum to 1");
    for (const auto& confusion : sensor.confusion) {
      for (const auto& row : confusion) require_distribution(row, "confusion rows sum to 1");
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto configuration = anchord::parse_configuration(text);
  if (configuration.ok()) {
    require_promises(configuration.knowledge());
  } else {
    require(!configuration.mistakes().empty(), "a refusal names its mistakes");
    for (const auto& mistake : configuration.mistakes()) {
      require(!mistake.message.empty(), "a mistake says something");
    }
  }
  return 0;
}
