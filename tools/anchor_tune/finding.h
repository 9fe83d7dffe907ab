#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/anchor_tune/estimate.h"

namespace anchord::tuning {

using JsonPath = nlohmann::json::json_pointer;

/// What goes into a configuration: a value in its place (null: nothing is to stand there), and
/// where it came from. Without `why` it comes without a comment.
struct Finding {
  JsonPath path;
  nlohmann::json value;
  std::string why;
  std::optional<Estimate> estimate{};  ///< what the value is the best of
};
using Findings = std::vector<Finding>;

/// A number that was estimated; its reason is `how`, the interval, `more`.
Finding estimated(JsonPath path, const Estimate& estimate, const std::string& how,
                  const std::string& more = "");

/// `classes.cup.models.0`, for people.
std::string dotted(const JsonPath& path);

/// A number as it is written: four significant digits; of what is nearly 1, in what it lacks.
nlohmann::json number(double value);

/// The configuration `base` (its includes merged in) with the findings in it, in order, as JSON
/// with each finding's reason as a comment above it. `title` is the comment at the top; findings
/// without path follow it.
std::string tuned_text(nlohmann::json base, const Findings& findings, const std::string& title);

/// The findings that have a reason, one to a line: "classes.cup.departure_rate 0.01: why". Without
/// a path it is a remark.
std::string report_text(const Findings& findings);

}  // namespace anchord::tuning
