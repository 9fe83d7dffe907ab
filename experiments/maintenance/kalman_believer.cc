#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "experiments/maintenance/believer.h"
#include "maintenance/entropy.h"

namespace anchord::experiment {
namespace {

class Kalman : public Believer {
 public:
  Kalman(const Scene& scene, const Site& site, Dice& dice) : site_(site) {
    const int dims = site.dims;
    for (const Thing& thing : scene.things) {
      Gaussian position;
      for (int i = 0; i < dims; ++i) position.covariance(i, i) = scene.initial_variance;
      const double spread = std::sqrt(scene.initial_variance);
      for (int i = 0; i < 2; ++i) position.mean[i] = thing.position[i] + spread * dice.normal();
      subjects_.push_back(single_subject("thing-" + std::to_string(subjects_.size()), position,
                                         thing.psd, 1, thing.object_class, scene.knowledge));
    }
  }

  void take(const Look& look, double time) override {
    predict(time);
    const Eye& eye = site_.eyes[static_cast<std::size_t>(look.eye)];
    for (const Look::Seen& seen : look.seen) {
      if (seen.thing < 0) continue;
      Subject::Track& track = subjects_[static_cast<std::size_t>(seen.thing)].tracks.front();
      Gaussian measured;
      measured.mean.head<2>() = seen.position;
      measured.covariance = eye.noise[static_cast<std::size_t>(seen.object_class)];
      update(track.state, measured, site_.dims);
    }
  }

  std::vector<Subject> subjects(double time) override {
    predict(time);
    return subjects_;
  }

  Entropies entropies(double time) override {
    predict(time);
    Entropies out{-std::numeric_limits<double>::infinity(), 0};
    for (const Subject& subject : subjects_) {
      const double h = gaussian_entropy(subject.tracks.front().state.pp, site_.dims);
      out.max = std::max(out.max, h);
      out.sum += h;
    }
    return out;
  }

 private:
  void predict(double time) {
    for (Subject& subject : subjects_)
      predict_constant_position(subject.tracks.front().state, subject.tracks.front().psd,
                                time - time_, site_.dims);
    time_ = time;
  }

  const Site& site_;
  std::vector<Subject> subjects_;
  double time_ = 0;
};

}  // namespace

std::unique_ptr<Believer> kalman_believer(const Scene& scene, const Site& site, Dice& dice) {
  return std::make_unique<Kalman>(scene, site, dice);
}

}  // namespace anchord::experiment
