#include <Eigen/Cholesky>
#include <algorithm>
#include <map>

#include "tools/anchor_tune/crowding.h"
#include "tools/anchor_tune/doubles.h"
#include "tools/anchor_tune/from_truth.h"
#include "tools/anchor_tune/labels.h"
#include "tools/anchor_tune/scores.h"

namespace anchord::tuning {
namespace {

/// Of detections.
struct Counts {
  std::int64_t right = 0, wrong = 0, neutral = 0;
  std::optional<double> clutter;  // of the wrong ones, where the others are phantoms
  std::vector<JudgedScore> scores;
};

/// What one sensor did over all its frames that have truth.
struct Tally {
  Counts all;
  std::map<int, Counts> by_label;
  std::int64_t frames = 0, unplaced = 0;
  double volume = 0;   // m^dims in view, summed over frames
  double squares = 0;  // of normalised residuals, dims for each right one
  bool scored = false;
  double crowding = 1;
};

Tally tally(const Judgement& judgement, int sensor, int dims) {
  Tally t;
  for (const JudgedFrame& frame : judgement.frames) {
    if (frame.sensor != sensor) continue;
    ++t.frames;
    t.volume += frame.volume;
    for (const Judged& z : frame.detections) {
      Counts& of_label = t.by_label[label(z.placed)];
      const bool right = z.verdict == Verdict::kRight;
      const auto counter = right                          ? &Counts::right
                           : z.verdict == Verdict::kFalse ? &Counts::wrong
                                                          : &Counts::neutral;
      ++(t.all.*counter);
      ++(of_label.*counter);
      if (z.verdict == Verdict::kNeutral) continue;
      t.scored = t.scored || z.score;
      t.all.scores.push_back({z.score.value_or(0.5), right, z.placed.range});
      of_label.scores.push_back(t.all.scores.back());
      if (!right) continue;
      if (z.needs_noise) ++t.unplaced;
      const Eigen::MatrixXd covariance = z.placed.position.covariance.topLeftCorner(dims, dims);
      const Eigen::VectorXd residual = z.residual.head(dims);
      t.squares += residual.dot(covariance.llt().solve(residual));
    }
  }
  return t;
}

/// What phantoms leave of the false ones for clutter.
void add_phantoms(const std::vector<Phantoms>& phantoms, int sensor, Tally& t) {
  double rest = 0;
  for (const Phantoms& p : phantoms) {
    const double clutter = p.clutter[static_cast<std::size_t>(sensor)];
    if (p.look >= 0) t.by_label[p.look].clutter = clutter;
    rest += clutter;
  }
  t.all.clutter = rest;
}

std::string counted(const Counts& counts, const Tally& t) {
  return std::to_string(counts.right) + " right, " + std::to_string(counts.wrong) + " false and " +
         std::to_string(counts.neutral) + " neutral detections in " + std::to_string(t.frames) +
         " frames";
}

/// Of all clutter, or of that which looks like something.
void add_clutter(const Tally& t, const Counts& counts, const JsonPath& at, const std::string& unit,
                 Findings& out) {
  const std::string view =
      rounded(t.volume / static_cast<double>(t.frames)) + " " + unit + " in view on average";
  const std::int64_t count = t.scored ? counts.right : counts.wrong;
  const double share =
      counts.clutter && counts.wrong > 0 ? *counts.clutter / static_cast<double>(counts.wrong) : 1;
  const double exposure = t.volume / t.crowding / std::max(share, 1e-3);
  Estimate kappa = poisson_rate(count, exposure);
  if (count == 0) kappa.value = 0.5 / exposure;
  std::string how = "Per " + unit;
  if (t.scored)
    how +=
        " at score 0.5. A score is the share of right ones among detections like it; so "
        "clutter of that look is as dense as right detections would be, were they spread like "
        "clutter";
  how += ": " + counted(counts, t) + ", " + view;
  if (counts.clutter)
    how += "; " + rounded(*counts.clutter) + " of the false ones are expected to be no phantoms";
  if (t.crowding > 1)
    how += "; where right ones are clutter is " + rounded(t.crowding) + " times as dense as that";
  out.push_back(estimated(at, kappa, how));
}

/// Of all scores, or of those with a label; returns what is written, or what counts without.
ScoreCalibration add_calibration(const std::vector<JudgedScore>& scores, const JsonPath& at,
                                 Findings& out) {
  const auto calibration = calibrate(scores);
  if (!calibration) return {};
  std::string fitted = "logit p' = a + b logit p";
  if (calibration->per_m) fitted += " + c range";
  fitted += " with a " + calibration->a.text() + ", b " + calibration->b.text();
  if (calibration->per_m) fitted += ", c " + calibration->per_m->text() + " per m";
  fitted += ", from " + std::to_string(scores.size()) +
            " scores; the log-likelihood of right and false gains " + rounded(calibration->gain);
  if (!calibration->off) {
    out.push_back({JsonPath(), nullptr, dotted(at) + ": scores are calibrated (" + fitted + ")"});
    return {};
  }
  nlohmann::json value{number(calibration->a.value), number(calibration->b.value)};
  if (calibration->per_m) value.push_back(number(calibration->per_m->value));
  out.push_back({at, value, "Scores are off: " + fitted + "."});
  return {calibration->a.value, calibration->b.value,
          calibration->per_m ? calibration->per_m->value : 0};
}

/// What tells a phantom's scores from an object's.
void add_real_share(const Counts& counts, const JsonPath& at, Findings& out) {
  if (counts.right == 0 || counts.wrong == 0) return;
  out.push_back(estimated(at, binomial_share(counts.right, counts.right + counts.wrong),
                          "Of right and false detections: a score is odds against these"));
}

/// Of phantoms of one look; scores count as `as` has them.
void add_score_memory(const Phantoms& phantoms, int sensor, const ScoreCalibration& as,
                      const JsonPath& at, Findings& out) {
  std::vector<ScoreSeries> wrong;
  for (const FalseChain& chain : phantoms.chains) {
    if (chain.sensor != sensor || chain.log_odds.size() != chain.track.seconds.size()) continue;
    ScoreSeries& series = wrong.emplace_back();
    series.seconds = chain.track.seconds;
    for (std::size_t i = 0; i < chain.log_odds.size(); ++i)
      series.log_odds.push_back(as.a + as.b * chain.log_odds[i] + as.per_m * chain.ranges[i]);
  }
  const auto likeness = fit_score_memory(wrong);
  if (!likeness) {
    out.push_back({JsonPath(), nullptr,
                   dotted(at) + ": the scores of one thing are no more alike than others"});
    return;
  }
  out.push_back(estimated(at / "share", likeness->share,
                          "Of the variance of one thing's false scores this part lasts: "
                          "maximum likelihood of " +
                              std::to_string(likeness->scores) + " of them"));
  out.push_back(estimated(at / "seconds", likeness->seconds, "For so long, from the same"));
}

/// Scores, clutter and shares of what is right: of all, or by label where phantoms look like one.
void add_false(const Tally& t, const std::vector<Phantoms>& phantoms, int sensor,
               const JsonPath& at, const Knowledge& knowledge, Findings& out) {
  const JsonPath density = at / "clutter_density", calibration = at / "score_calibration",
                 share = at / "real_share", memory = at / "score_memory";
  const std::string unit = knowledge.dims == 2 ? "m^2" : "m^3";
  const bool odds = !phantoms.empty() && t.scored;
  const bool by_label =
      std::any_of(phantoms.begin(), phantoms.end(), [](const Phantoms& p) { return p.look >= 0; });
  if (t.volume <= 0)
    out.push_back(
        {JsonPath(), nullptr, dotted(at) + ": nothing was in view, clutter is as it was"});
  out.push_back({calibration, nullptr, ""});
  if (odds) out.push_back({memory, nullptr, ""});
  const auto add = [&](const Counts& counts, int label) {
    const auto of = [&](const JsonPath& all) {
      return label < 0 ? all : all / knowledge.classes[static_cast<std::size_t>(label)].name;
    };
    if (t.volume > 0) add_clutter(t, counts, of(density), unit, out);
    const ScoreCalibration as =
        t.scored ? add_calibration(counts.scores, of(calibration), out) : ScoreCalibration{};
    if (!odds) return;
    add_real_share(counts, of(share), out);
    for (const Phantoms& p : phantoms)
      if (p.look == label) add_score_memory(p, sensor, as, of(memory), out);
  };
  if (!by_label) return add(t.all, -1);
  out.push_back({density, nlohmann::json::object(),
                 "By what it looks like: that is taken to be as what it is reported."});
  if (odds) out.push_back({share, nlohmann::json::object(), "By label, too."});
  for (const auto& [label, counts] : t.by_label)
    if (label >= 0) add(counts, label);
}

void add_doubles(const Judgement& judgement, int sensor, const Tally& t, double radius,
                 const JsonPath& at, int dims, Findings& out) {
  if (t.volume <= 0 || t.all.wrong == 0) return;
  const double density =
      static_cast<double>(t.all.wrong) / t.volume * crowding(judgement, sensor, radius, dims);
  const auto doubles = fit_doubles(judgement, sensor, density, dims);
  if (!doubles) return;
  out.push_back(estimated(at / "double_detection", doubles->often,
                          rounded(doubles->repeats) + " of " + std::to_string(doubles->detections) +
                              " detections are expected to repeat one of the same frame that is "
                              "surer"));
}

void add_labels(const Judgement& judgement, int sensor, const Knowledge& knowledge,
                const JsonPath& at, Findings& out) {
  const auto n = static_cast<int>(knowledge.classes.size());
  const auto labels = fit_labels(judgement, sensor, n);
  if (!labels) return;
  const std::string losses = "mean -ln P(true class) of " + std::to_string(labels->pairs) +
                             " right detections: " + rounded(labels->loss) +
                             " with reports taken as likelihoods, " +
                             rounded(labels->confusion_loss) + " through the matrix";
  const JsonPath confusion = at / "confusion" / "class";
  if (!labels->confused) {
    out.push_back({confusion, nullptr, ""});
    out.push_back({at / "prior" / "class", nullptr, ""});
    out.push_back(
        {JsonPath(), nullptr, dotted(at) + ": no confusion matrix is needed (" + losses + ")"});
    return;
  }
  out.push_back({confusion, nlohmann::json::object(), "Rows are true classes; " + losses + "."});
  for (std::size_t s = 0; s < labels->confusion.size(); ++s) {
    if (knowledge.classes[s].phantom) continue;
    nlohmann::json row;
    std::int64_t pairs = 0;
    for (std::size_t j = 0; j < labels->confusion.size(); ++j) {
      if (knowledge.classes[j].phantom) continue;
      row[knowledge.classes[j].name] = number(labels->confusion[s][j]);
      pairs += labels->counts[s][j];
    }
    out.push_back({confusion / knowledge.classes[s].name, row,
                   "Of " + std::to_string(pairs) + " right detections, half a one added to each."});
  }
}

void add_noise(const Tally& t, const Sensor& settings, const JsonPath& at, int dims,
               Findings& out) {
  if (t.all.right == 0) return;
  const Estimate scale = variance_scale(t.squares, t.all.right * dims);
  if (t.unplaced > 0) {
    nlohmann::json noise = nlohmann::json::array();
    for (const double v : settings.noise) noise.push_back(number(v));
    out.push_back({at / "noise", noise,
                   "Second moments of detection less truth in the sensor's frame, m^2, from " +
                       std::to_string(t.unplaced) + " right detections without a covariance."});
    return;
  }
  out.push_back({JsonPath(), nullptr,
                 dotted(at) + ": squared residuals of right detections are " + scale.text() +
                     " times what the reported covariances say (" + std::to_string(t.all.right) +
                     " of them; errors that last over frames make the interval too narrow)"});
}

}  // namespace

Findings sensor_findings(const Judgement& judgement, int sensor,
                         const std::vector<Phantoms>& phantoms, const Knowledge& knowledge,
                         double radius) {
  const std::string& name = judgement.sensors[static_cast<std::size_t>(sensor)];
  const JsonPath at = JsonPath("/sensors") / name;
  Tally t = tally(judgement, sensor, knowledge.dims);
  if (!phantoms.empty())  // what is new is held against phantoms that are new, which are as crowded
    add_phantoms(phantoms, sensor, t);
  else
    t.crowding = crowding(judgement, sensor, radius, knowledge.dims);
  Findings out;
  add_false(t, phantoms, sensor, at, knowledge, out);
  add_doubles(judgement, sensor, t, radius, at, knowledge.dims, out);
  add_labels(judgement, sensor, knowledge, at, out);
  add_noise(t, knowledge.sensor(name), at, knowledge.dims, out);
  return out;
}

}  // namespace anchord::tuning
