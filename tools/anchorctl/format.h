#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/time.h"
#include "tools/anchorctl/fields.h"

namespace anchord {

/// How numbers, times and positions are written for people. What is not known is "-".

/// Two decimals, three where two would say 0 or 1: "0.97", "0.996", "<0.001", ">0.999".
std::string probability(std::optional<double> p);

/// With so many decimals; very large ones in scientific notation.
std::string decimal(double value, int decimals = 2);

/// A span in the unit that suits it: "0.31 ms", "3.2 s", "12 min", "3.1 h", "5.0 days".
std::string duration(double seconds);

/// "0 B", "1.2 MB" (powers of 1000).
std::string bytes(double count);

/// Local date and time to the second, with the time zone: "2023-11-14 22:13:20 UTC".
std::string date_and_time(std::optional<Utime> utime);

/// Local time: "22:13:20"; with the date unless that is the newest frame's.
std::string time_near(std::optional<Utime> utime, std::optional<Utime> newest);

/// When something was last seen: local time, and how long before the newest frame; with the date
/// unless that is the newest frame's: "22:13:20 (3.2 s ago)", "22:13:20 (now)".
std::string seen(std::optional<Utime> utime, std::optional<Utime> newest);

/// Local time of day: "22:13:20".
std::string time_of_day(std::optional<Utime> utime);

/// "1.02, 0.20, 0.90", or with a standard deviation: "1.02, 0.20, 0.90 ±0.05" (m). That is the
/// largest of the axes', from the diagonal of `covariance` (row-major).
std::string position(const std::vector<double>& position,
                     const std::vector<double>& covariance = {});

/// The standard deviation of each axis; empty if `covariance` is no square matrix of that size.
std::vector<double> axis_sigmas(const std::vector<double>& covariance, std::size_t dimensions);

/// "cup 0.98", the most probable symbol of an object's attribute `class`. A plain string is taken
/// as it is.
std::string class_of(const Json& object);

/// A distribution or a scalar: "blue 0.90, green 0.08" (p >= 0.01, most probable first),
/// "0.120 ±0.020 m".
std::string attribute(const Json& value);

}  // namespace anchord
