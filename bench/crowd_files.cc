#include "bench/crowd_files.h"

#include <fstream>
#include <iomanip>
#include <limits>
#include <variant>

namespace anchord::bench {
namespace {

std::ofstream opened(const std::string& path) {
  std::ofstream file(path);
  file << std::setprecision(std::numeric_limits<double>::max_digits10);
  return file;
}

void write_frame(const Frame& frame, std::ostream& out) {
  out << R"({"utime": )" << frame.utime << R"(, "sensor": ")" << frame.sensor
      << R"(", "view": {"type": "world"}, "detections": [)";
  const char* separator = "";
  for (const Detection& detection : frame.detections) {
    const auto& measured = std::get<CartesianMeasurement>(detection.measurement);
    const double variance = measured.covariance.front();
    out << separator << R"({"position": [)" << measured.position[0] << ", " << measured.position[1]
        << R"(], "covariance": [)" << variance << ", 0, 0, " << variance << "]}";
    separator = ", ";
  }
  out << "]}\n";
}

}  // namespace

bool write_crowd(const Crowd& crowd, const CrowdParameters& parameters, int first,
                 const std::string& prefix) {
  std::ofstream frames = opened(prefix + ".frames.jsonl"), truth = opened(prefix + ".truth.csv");
  std::ofstream index = opened(prefix + ".index.csv"), configuration = opened(prefix + ".json");
  configuration << crowd_configuration(parameters);
  truth << "frame,id,x,y\n";
  index << "utime,frame\n";
  for (int k = 0; k < static_cast<int>(crowd.frames.size()); ++k) {
    write_frame(crowd.frames[k], frames);
    if (k < first) continue;
    index << crowd.frames[k].utime << ',' << k << '\n';
    for (std::size_t i = 0; i < crowd.truth[k].size(); ++i)
      truth << k << ',' << i << ',' << crowd.truth[k][i].x() << ',' << crowd.truth[k][i].y()
            << '\n';
  }
  for (std::ofstream* file : {&frames, &truth, &index, &configuration})
    if (!file->flush()) return false;
  return true;
}

}  // namespace anchord::bench
