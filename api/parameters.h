#pragma once

#include <optional>
#include <string>

#include "anchoring/reading.h"
#include "api/http_message.h"
#include "core/result.h"

namespace anchord {

/// The parameters of a question, resolved against the knowledge.
struct Parameters {
  Description description;      ///< `class=cup`, `color=blue`, `size=small`: all must hold
  int place = -1;               ///< `place=`, or -1
  std::optional<double> min_p;  ///< `min_p=`
  std::string object;           ///< `object=`
  int limit = 10;               ///< `limit=`
  bool filters() const { return !description.terms.empty() || place >= 0; }
};

/// Reads them. `allowed` names, separated by spaces, those of place, min_p, object and limit that
/// the question takes, and "description" if it takes attributes. Refused (kInvalid): an unknown
/// parameter, place, symbol or predicate, a parameter given twice, a number that is none.
Result<Parameters> read_parameters(const HttpTarget& target, const std::string& allowed,
                                   const Background& background);

}  // namespace anchord
