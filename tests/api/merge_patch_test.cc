#include "api/merge_patch.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace anchord {
namespace {

using nlohmann::json;

/// JSON without a null, of members whose names are often the same.
json any_json(int depth) {
  switch (*rc::gen::inRange(0, depth > 0 ? 5 : 3)) {
    case 0:
      return *rc::gen::inRange(0, 3);
    case 1:
      return std::string(1, *rc::gen::elementOf(std::string("xyz")));
    case 2:
      return json::array({*rc::gen::inRange(0, 2), "one"});
    default: {
      json out = json::object();
      const int count = *rc::gen::inRange(0, 4);
      for (int i = 0; i < count; ++i)
        out[std::string(1, *rc::gen::elementOf(std::string("abcd")))] = any_json(depth - 1);
      return out;
    }
  }
}

RC_GTEST_PROP(MergePatch, MakesOneOfTheOther, ()) {
  const json from = any_json(3), to = any_json(3);
  const auto patch = merge_patch(from, to);
  RC_ASSERT(patch.has_value() == (from != to));
  if (!patch) return;
  json patched = from;
  patched.merge_patch(*patch);
  RC_ASSERT(patched == to);
}

TEST(MergePatch, TellsWhatDiffersOnly) {
  const json from = {
      {"objects", {{"cup-1", {{"p", 0.9}, {"position", {1, 2}}}}, {"cup-2", {{"p", 1}}}}},
      {"utime", 1}};
  json to = from;
  to["objects"]["cup-1"]["p"] = 0.8;
  to["objects"].erase("cup-2");
  EXPECT_EQ(*merge_patch(from, to),
            json({{"objects", {{"cup-1", {{"p", 0.8}}}, {"cup-2", nullptr}}}}));
}

}  // namespace
}  // namespace anchord
