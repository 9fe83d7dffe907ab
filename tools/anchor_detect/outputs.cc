#include "outputs.h"

#include "api/frame_json.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/codec.h"

namespace anchord {

Status Outputs::create(std::ofstream& file, const std::string& path) {
  if (path.empty()) return Done{};
  file.open(path, std::ios::binary | std::ios::trunc);
  if (!file) return Error{ErrorCode::kIo, path, "cannot be written"};
  return Done{};
}

Result<std::unique_ptr<Outputs>> Outputs::open(const Settings& settings) {
  std::unique_ptr<Outputs> outputs(new Outputs);
  if (auto done = outputs->create(outputs->log_file_, settings.log); !done) return done.error();
  if (auto done = outputs->create(outputs->jsonl_, settings.jsonl); !done) return done.error();
  if (auto done = outputs->create(outputs->features_, settings.features); !done) {
    return done.error();
  }
  if (!settings.log.empty()) outputs->log_.emplace(outputs->log_file_);
  if (settings.lcm_url) {
    auto bus = LcmBus::open(*settings.lcm_url);
    if (!bus) return bus.error();
    outputs->bus_ = std::move(*bus);
  }
  if (outputs->features_.is_open()) {
    outputs->features_ << "frame,x,y,cxx,cxy,cyy,score,foot_u,foot_v,height_px,gain,filled,"
                          "observed,alone,likeness,colors\n";
  }
  return outputs;
}

void Outputs::write_features(int index, const std::vector<DetectedPerson>& people) {
  for (const DetectedPerson& person : people) {
    const FoundPerson& found = person.found;
    const Eigen::Matrix2d& c = person.covariance;
    features_ << index << ',' << person.position.x() << ',' << person.position.y() << ',' << c(0, 0)
              << ',' << c(0, 1) << ',' << c(1, 1) << ',' << person.score << ','
              << found.silhouette.foot.x() << ',' << found.silhouette.foot.y() << ','
              << found.silhouette.height_px() << ',' << found.gain << ',' << found.filled << ','
              << found.observed << ',' << found.alone << ',' << person.likeness << ',';
    for (const double share : person.colors) features_ << share << ' ';
    features_ << '\n';
  }
}

Status Outputs::write(int index, const Frame& frame, const std::vector<DetectedPerson>& people) {
  if (bus_) {
    if (auto done = bus_->publish(kDetectionsChannel, encode(frame, index)); !done) return done;
  }
  if (log_) {
    if (auto done = log_->write_frame(frame); !done) return done;
  }
  if (jsonl_.is_open()) jsonl_ << to_json(frame).dump() << '\n';
  if (features_.is_open()) write_features(index, people);
  for (const std::ofstream* file : {&log_file_, &jsonl_, &features_}) {
    if (file->is_open() && !*file) return Error{ErrorCode::kIo, "", "an output cannot be written"};
  }
  return Done{};
}

}  // namespace anchord
