#include "tools/anchor_tune/from_truth.h"

#include <map>

#include "tools/anchor_tune/knowledge_parts.h"

namespace anchord::tuning {
namespace {

/// What must not colour the judgement: reports of the class and scores are to be seen as reported.
Knowledge bare(Knowledge knowledge, double radius) {
  const auto strip = [&](Sensor& sensor) {
    if (knowledge.class_attribute >= 0) {
      const auto a = static_cast<std::size_t>(knowledge.class_attribute);
      sensor.confusion[a].clear();
      sensor.prior[a].clear();
    }
    sensor.score_calibration = {};
    if (!sensor.noise.empty()) return;
    const int d = knowledge.dims;
    sensor.noise.assign(static_cast<std::size_t>(d * d), 0);
    for (int i = 0; i < d; ++i)
      sensor.noise[static_cast<std::size_t>(i * (d + 1))] = radius * radius / 4;
  };
  for (Sensor& sensor : knowledge.sensors) strip(sensor);
  strip(knowledge.default_sensor);
  return knowledge;
}

/// The second moments of the residuals, sensor frame, where the sensor's noise holds. Changes
/// nothing and returns false where it does not.
bool fit_noise(const Judgement& judgement, int sensor, Knowledge& knowledge) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  int count = 0;
  for (const JudgedFrame& frame : judgement.frames)
    for (const Judged& z : frame.detections) {
      if (frame.sensor != sensor || z.verdict != Verdict::kRight || !z.needs_noise) continue;
      sum += z.sensor_residual * z.sensor_residual.transpose();
      ++count;
    }
  if (count <= knowledge.dims) return false;
  std::vector<double>& noise =
      own_settings(knowledge, judgement.sensors[static_cast<std::size_t>(sensor)]).noise;
  const int d = knowledge.dims;
  for (int i = 0; i < d; ++i)
    for (int j = 0; j < d; ++j) noise[static_cast<std::size_t>(i * d + j)] = sum(i, j) / count;
  return true;
}

/// Of all classes that are phantoms, by what they look like; their chains are kept for the sensors.
/// Those that look like anything are told from detections that no other looks like.
Findings findings_of_phantoms(const Judgement& judgement, const Knowledge& knowledge, double radius,
                              std::vector<Phantoms>& phantoms) {
  std::map<int, std::vector<int>> by_look;
  bool single = true;
  for (std::size_t c = 0; c < knowledge.classes.size(); ++c) {
    if (!knowledge.classes[c].phantom) continue;
    by_look[knowledge.classes[c].looks_like].push_back(static_cast<int>(c));
    single = single && single_model(knowledge.classes[c]) >= 0;
  }
  Findings out;
  for (const auto& [look, classes] : by_look) {
    const auto wanted = [&by_look, look = look](const Judged& z) {
      return look < 0 ? !by_look.count(label(z.placed)) || label(z.placed) < 0
                      : label(z.placed) == look;
    };
    auto found =
        single ? find_phantoms(judgement, wanted, look, classes, knowledge, radius) : std::nullopt;
    if (!found) {
      out.push_back(
          {JsonPath(), nullptr,
           "Phantoms" + (look < 0 ? "" : " that look like " + knowledge.classes[look].name) +
               " have several tracked models, or nothing false was seen twice; they are as they "
               "were"});
      continue;
    }
    for (std::size_t k = 0; k < classes.size(); ++k)
      for (Finding& f : phantom_findings(judgement, classes[k], *found, k, knowledge))
        out.push_back(std::move(f));
    phantoms.push_back(std::move(*found));
  }
  return out;
}

}  // namespace

Result<Findings> findings_from_truth(const std::vector<Recording>& recordings,
                                     const Knowledge& knowledge, const TruthOptions& options) {
  Knowledge judging = bare(knowledge, options.radius);
  auto judgement = judge(recordings, options.radius, Background(judging));
  if (!judgement) return judgement.error();
  bool better_noise = false;
  for (std::size_t s = 0; s < judgement->sensors.size(); ++s)
    better_noise = fit_noise(*judgement, static_cast<int>(s), judging) || better_noise;
  if (better_noise) judgement = judge(recordings, options.radius, Background(judging));
  if (!judgement) return judgement.error();

  Findings all;
  for (std::size_t c = 0; c < knowledge.classes.size(); ++c) {
    if (knowledge.classes[c].phantom) continue;
    const auto found = class_findings(*judgement, static_cast<int>(c), judging, options);
    all.insert(all.end(), found.begin(), found.end());
  }
  std::vector<Phantoms> phantoms;
  const auto false_ones = findings_of_phantoms(*judgement, judging, options.radius, phantoms);
  all.insert(all.end(), false_ones.begin(), false_ones.end());
  for (std::size_t s = 0; s < judgement->sensors.size(); ++s) {
    const auto found =
        sensor_findings(*judgement, static_cast<int>(s), phantoms, judging, options.radius);
    all.insert(all.end(), found.begin(), found.end());
  }
  return all;
}

}  // namespace anchord::tuning
