#include "perception/person_search.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace anchord {

namespace {

/// Rectangles that stand for the silhouette when all places are tried: top, bottom and half width
/// in heights, and the mean coverage inside.
struct Block {
  double top, bottom, half_width, coverage;
};
constexpr std::array<Block, 3> kBlocks = {
    {{0.02, 0.17, 0.07, 0.65}, {0.17, 0.62, 0.14, 0.78}, {0.62, 0.97, 0.12, 0.60}}};

constexpr double kRoughness = 0.8;  ///< blocks are rougher than silhouettes: they pass with less
constexpr double kHeightWeight =
    0.01;  ///< of the prior: pixels of one person are far from independent
constexpr int kSweeps = 2;

/// How much of a person is seen, given the others.
FoundPerson measured(const Silhouette& person, const std::vector<Silhouette>& people,
                     const cv::Mat1f& foreground, const cv::Mat1b& observable) {
  const cv::Rect picture(cv::Point(), foreground.size());
  const cv::Rect box = person.box();
  double body = 0, observed = 0, filled = 0, alone = 0;
  for (int y = box.y; y < box.br().y; ++y) {
    for (int x = box.x; x < box.br().x; ++x) {
      const double coverage = person.coverage(x, y);
      body += coverage;
      if (coverage == 0 || !picture.contains({x, y}) || !observable(y, x)) continue;
      double nearer = 1;
      for (const Silhouette& other : people) {
        if (other.foot.y() > person.foot.y()) nearer *= 1 - other.coverage(x, y);
      }
      observed += coverage;
      filled += coverage * foreground(y, x);
      alone += coverage * nearer;
    }
  }
  FoundPerson result;
  result.silhouette = person;
  result.observed = observed / body;
  result.filled = observed > 0 ? filled / observed : 0;
  result.alone = observed > 0 ? alone / observed : 0;
  return result;
}

}  // namespace

PersonSearch::PersonSearch(const Camera& camera, const cv::Mat1b& observable,
                           const Settings& settings)
    : camera_(camera), observable_(observable), settings_(settings) {
  const cv::Rect picture(0, 0, camera.width(), camera.height());
  for (int v = settings.least_foot_row; v < camera.height() + settings.rows_below;
       v += settings.step) {
    for (int u = -settings.columns_beside; u < camera.width() + settings.columns_beside;
         u += settings.step) {
      const std::optional<Silhouette> person = stand(camera, {u, v}, settings.height_m);
      if (!person) continue;
      Candidate candidate{*person, {}, 0};
      const double h = person->height_px();
      for (const Block& b : kBlocks) {
        const double share = 0.5 * (b.top + b.bottom);
        const double x = person->head.x() + share * (person->foot.x() - person->head.x());
        const double y = person->head.y();
        const cv::Rect area(cv::Point(cvRound(x - b.half_width * h), cvRound(y + b.top * h)),
                            cv::Point(cvRound(x + b.half_width * h), cvRound(y + b.bottom * h)));
        const double hit = std::log(b.coverage / settings.false_foreground);
        const double miss = std::log((1 - b.coverage) / (1 - settings.false_foreground));
        candidate.full_gain += area.area() * (b.coverage * hit + (1 - b.coverage) * miss);
        candidate.parts.push_back({area & picture, hit, miss});
      }
      candidates_.push_back(candidate);
    }
  }
}

double PersonSearch::rough_gain(const Explanation& explanation, const Candidate& candidate) const {
  double gain = 0;
  for (const Part& part : candidate.parts) {
    gain += part.hit * explanation.news(part.area) + part.miss * explanation.holes(part.area);
  }
  return gain;
}

double PersonSearch::gain_with_prior(const Explanation& explanation,
                                     const Silhouette& person) const {
  const double z = (person.height_m - settings_.height_m) / settings_.height_deviation_m;
  const Explanation::Gain gain = explanation.gain(person);
  return gain.won - kHeightWeight * z * z * gain.full;
}

Silhouette PersonSearch::refined(const Explanation& explanation, Silhouette person) const {
  double best = gain_with_prior(explanation, person);
  for (double step = settings_.step; step >= 1; step /= 2) {
    const double taller = 0.02 * step;
    const std::array<Eigen::Vector3d, 8> moves = {{{-step, 0, 0},
                                                   {step, 0, 0},
                                                   {0, -step, 0},
                                                   {0, step, 0},
                                                   {0, 0, -taller},
                                                   {0, 0, taller},
                                                   {0, step, taller},
                                                   {0, -step, -taller}}};
    for (bool moved = true; moved;) {
      moved = false;
      const Silhouette from = person;
      for (const Eigen::Vector3d& move : moves) {
        const std::optional<Silhouette> there =
            stand(camera_, from.foot + move.head<2>(), from.height_m + move.z());
        if (!there || there->foot.y() < settings_.least_foot_row) continue;
        const double gain = gain_with_prior(explanation, *there);
        if (gain <= best) continue;
        best = gain;
        person = *there;
        moved = true;
      }
    }
  }
  return person;
}

std::vector<Silhouette> PersonSearch::explain(Explanation& explanation) const {
  // Gains only fall as people are added, so what fails once need not be tried again.
  std::vector<const Candidate*> hopeful;
  for (const Candidate& candidate : candidates_) hopeful.push_back(&candidate);
  std::vector<Silhouette> people;
  while (static_cast<int>(people.size()) < settings_.most) {
    const Candidate* best = nullptr;
    double best_gain = 0;
    std::erase_if(hopeful, [&](const Candidate* candidate) {
      const double gain = rough_gain(explanation, *candidate);
      if (gain < kRoughness * settings_.least_gain * candidate->full_gain) return true;
      if (gain > best_gain) {
        best_gain = gain;
        best = candidate;
      }
      return false;
    });
    if (!best) break;
    const Silhouette person = refined(explanation, best->silhouette);
    if (explanation.gain(person).share() < settings_.least_gain) {
      std::erase(hopeful, best);
      continue;
    }
    people.push_back(person);
    explanation.add(person);
    explanation.sum_up();
  }
  return people;
}

void PersonSearch::settle(Explanation& explanation, std::vector<Silhouette>& people) const {
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (Silhouette& person : people) {
      explanation.remove(person);
      person = refined(explanation, person);
      explanation.add(person);
    }
  }
}

std::vector<double> PersonSearch::gains(Explanation& explanation,
                                        const std::vector<Silhouette>& people) const {
  std::vector<double> result;
  for (const Silhouette& person : people) {
    explanation.remove(person);
    result.push_back(explanation.gain(person).share());
    explanation.add(person);
  }
  return result;
}

std::vector<FoundPerson> PersonSearch::find(const cv::Mat1f& foreground) const {
  Explanation explanation(foreground, observable_, settings_.false_foreground);
  std::vector<Silhouette> people = explain(explanation);
  settle(explanation, people);
  std::vector<double> gain = gains(explanation, people);
  // Of two who explain the same, one must stay: whoever is needed least goes, one at a time.
  while (!people.empty()) {
    const auto least = std::min_element(gain.begin(), gain.end());
    if (*least >= settings_.least_gain) break;
    const auto person = people.begin() + (least - gain.begin());
    explanation.remove(*person);
    people.erase(person);
    settle(explanation, people);
    gain = gains(explanation, people);
  }
  std::vector<FoundPerson> found;
  for (std::size_t i = 0; i < people.size(); ++i) {
    found.push_back(measured(people[i], people, foreground, observable_));
    found.back().gain = gain[i];
  }
  return found;
}

}  // namespace anchord
