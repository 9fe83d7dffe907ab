#include <Eigen/Cholesky>

#include "tools/anchor_tune/crowding.h"
#include "tools/anchor_tune/from_truth.h"
#include "tools/anchor_tune/labels.h"
#include "tools/anchor_tune/scores.h"

namespace anchord::tuning {
namespace {

/// What one sensor did over all its frames that have truth.
struct Tally {
  std::int64_t frames = 0, right = 0, wrong = 0, neutral = 0, unplaced = 0;
  double volume = 0;   // m^dims in view, summed over frames
  double squares = 0;  // of normalised residuals, dims for each right one
  bool scored = false;
  double crowding = 1;
  std::optional<double> clutter;  // of the wrong ones, where the others are phantoms
  std::vector<JudgedScore> scores;
};

Tally tally(const Judgement& judgement, int sensor, int dims) {
  Tally t;
  for (const JudgedFrame& frame : judgement.frames) {
    if (frame.sensor != sensor) continue;
    ++t.frames;
    t.volume += frame.volume;
    for (const Judged& z : frame.detections) {
      if (z.verdict == Verdict::kNeutral) {
        ++t.neutral;
        continue;
      }
      const bool right = z.verdict == Verdict::kRight;
      ++(right ? t.right : t.wrong);
      t.scored = t.scored || z.score;
      t.scores.push_back({z.score.value_or(0.5), right});
      if (!right) continue;
      if (z.needs_noise) ++t.unplaced;
      const Eigen::MatrixXd covariance = z.placed.position.covariance.topLeftCorner(dims, dims);
      const Eigen::VectorXd residual = z.residual.head(dims);
      t.squares += residual.dot(covariance.llt().solve(residual));
    }
  }
  return t;
}

std::string counted(const Tally& t) {
  return std::to_string(t.right) + " right, " + std::to_string(t.wrong) + " false and " +
         std::to_string(t.neutral) + " neutral detections in " + std::to_string(t.frames) +
         " frames";
}

void add_clutter(const Tally& t, const JsonPath& at, const std::string& unit, Findings& out) {
  if (t.volume <= 0) {
    out.push_back(
        {JsonPath(), nullptr, dotted(at) + ": nothing was in view, clutter is as it was"});
    return;
  }
  const std::string view =
      rounded(t.volume / static_cast<double>(t.frames)) + " " + unit + " in view on average";
  const std::int64_t count = t.scored ? t.right : t.wrong;
  const double share = t.clutter && t.wrong > 0 ? *t.clutter / static_cast<double>(t.wrong) : 1;
  const double exposure = t.volume / t.crowding / std::max(share, 1e-3);
  Estimate kappa = poisson_rate(count, exposure);
  if (count == 0) kappa.value = 0.5 / exposure;
  std::string how = "Per " + unit;
  if (t.scored)
    how +=
        " at score 0.5. A score is the share of right ones among detections like it; so "
        "clutter of that look is as dense as right detections would be, were they spread like "
        "clutter";
  how += ": " + counted(t) + ", " + view;
  if (t.clutter)
    how += "; " + rounded(*t.clutter) + " of the false ones are expected to be no phantoms";
  if (t.crowding > 1)
    how += "; where right ones are clutter is " + rounded(t.crowding) + " times as dense as that";
  out.push_back(estimated(at / "clutter_density", kappa, how));
}

void add_calibration(const Tally& t, const JsonPath& at, Findings& out) {
  out.push_back({at / "score_calibration", nullptr, ""});
  if (!t.scored) return;
  const auto calibration = calibrate(t.scores);
  if (!calibration) return;
  const std::string fitted = "logit p' = a + b logit p with a " + calibration->a.text() + ", b " +
                             calibration->b.text() + ", from " + std::to_string(t.scores.size()) +
                             " scores; the log-likelihood of "
                             "right and false gains " +
                             rounded(calibration->gain);
  if (!calibration->off) {
    out.push_back({JsonPath(), nullptr, dotted(at) + ": scores are calibrated (" + fitted + ")"});
    return;
  }
  out.push_back({at / "score_calibration",
                 {number(calibration->a.value), number(calibration->b.value)},
                 "Scores are off: " + fitted + "."});
}

/// What tells a phantom's scores from an object's.
void add_score_odds(const Tally& t, const Phantoms& phantoms, int sensor, const JsonPath& at,
                    Findings& out) {
  if (t.right == 0 || t.wrong == 0) return;
  out.push_back(estimated(at / "real_share", binomial_share(t.right, t.right + t.wrong),
                          "Of right and false detections: a score is odds against these"));
  std::vector<ScoreSeries> wrong;
  for (const FalseChain& chain : phantoms.chains)
    if (chain.sensor == sensor && chain.log_odds.size() == chain.track.seconds.size())
      wrong.push_back({chain.track.seconds, chain.log_odds});
  const auto likeness = fit_score_memory(wrong);
  out.push_back({at / "score_memory", nullptr, ""});
  if (!likeness) {
    out.push_back({JsonPath(), nullptr,
                   dotted(at) + ": the scores of one thing are no more alike than others"});
    return;
  }
  out.push_back(estimated(at / "score_memory" / "share", likeness->share,
                          "Of the variance of one thing's false scores this part lasts: "
                          "maximum likelihood of " +
                              std::to_string(likeness->scores) + " of them"));
  out.push_back(
      estimated(at / "score_memory" / "seconds", likeness->seconds, "For so long, from the same"));
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
  if (t.right == 0) return;
  const Estimate scale = variance_scale(t.squares, t.right * dims);
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
                     " times what the reported covariances say (" + std::to_string(t.right) +
                     " of them; errors that last over frames make the interval too narrow)"});
}

}  // namespace

Findings sensor_findings(const Judgement& judgement, int sensor,
                         const std::optional<Phantoms>& phantoms, const Knowledge& knowledge,
                         double radius) {
  const std::string& name = judgement.sensors[static_cast<std::size_t>(sensor)];
  const JsonPath at = JsonPath("/sensors") / name;
  Tally t = tally(judgement, sensor, knowledge.dims);
  if (phantoms)  // what is new is held against phantoms that are new, which are as crowded
    t.clutter = phantoms->clutter[static_cast<std::size_t>(sensor)];
  else
    t.crowding = crowding(judgement, sensor, radius, knowledge.dims);
  Findings out;
  add_clutter(t, at, knowledge.dims == 2 ? "m^2" : "m^3", out);
  add_calibration(t, at, out);
  if (phantoms && t.scored) add_score_odds(t, *phantoms, sensor, at, out);
  add_labels(judgement, sensor, knowledge, at, out);
  add_noise(t, knowledge.sensor(name), at, knowledge.dims, out);
  return out;
}

}  // namespace anchord::tuning
