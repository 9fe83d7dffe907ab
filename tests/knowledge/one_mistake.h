#pragma once

#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "knowledge/configuration.h"

namespace anchord {

/// A configuration with one mistake.
struct OneMistake {
  const char* more;     ///< beside what all have in common
  const char* path;     ///< where the mistake is
  const char* message;  ///< a part of what it says
};

/// What gtest says when a case fails.
inline void PrintTo(const OneMistake& mistake, std::ostream* out) { *out << mistake.more; }

inline void expect_noted(const Configuration& configuration, const OneMistake& mistake) {
  std::string all;
  for (const ConfigurationMistake& found : configuration.mistakes()) all += found.text() + "\n";
  ASSERT_EQ(configuration.mistakes().size(), 1u) << mistake.more << ": " << all;
  EXPECT_EQ(configuration.mistakes()[0].path, mistake.path);
  EXPECT_NE(configuration.mistakes()[0].message.find(mistake.message), std::string::npos)
      << configuration.mistakes()[0].message;
}

}  // namespace anchord
