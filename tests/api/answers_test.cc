#include "api/answers.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/anchoring/small_events.h"

namespace anchord {
namespace {

/// Sums over some hundred hypotheses.
constexpr double kRounding = 1e-9;

/// Cups and a box so close that it is open which detection is whose, one that may be clutter, one
/// in the hall; colours and sizes of some.
World ambiguous() {
  Knowledge knowledge = small_world(R"({"classes": {
      "default": {"arrival_rate": 0.001, "models": [
        {"kind": "constant_velocity", "acceleration_psd": 0.01, "initial_velocity_variance": 0.01},
        {"kind": "somewhere", "place": "kitchen", "rate": 0.02}]},
      "cup": {"extent": [0.1, 0.1, 0.12]}}})");
  World world(knowledge);
  Detection red = at(1.2, 1.5, 0.01), large = at(1.45, 1.5, 0.01), box = at(4, 1, 0.01);
  red.attributes = {{"class", SymbolReport{{{"cup", 0.8}}}},
                    {"color", SymbolReport{{{"red", 0.9}}}}};
  large.attributes = {{"class", SymbolReport{{{"cup", 0.6}}}}, {"size", ScalarReport{0.2, 0.001}}};
  box.attributes = {{"class", SymbolReport{{{"box", 0.95}}}}};
  Detection ghost = at(1.3, 1.8, 0.02);
  ghost.score = 0.05;
  apply(world, {frame(0, {red, large, box}), frame(0.5, {at(1.3, 1.5, 0.01), ghost, box}),
                frame(1, {at(1.25, 1.55, 0.01), at(1.4, 1.5, 0.01), box}), frame(1.5, {ghost})});
  return world;
}

Snapshot snapshot_of(const World& world) { return {world.belief(), world.background()}; }

HttpResponse ask(const World& world, const std::string& target) {
  const auto parsed = parse_target(target);
  EXPECT_TRUE(parsed.ok()) << target;
  return answer(*parsed, snapshot_of(world));
}

Json get(const World& world, const std::string& target) {
  const HttpResponse response = ask(world, target);
  EXPECT_EQ(response.status, 200) << response.body;
  EXPECT_EQ(response.content_type, "application/json");
  return Json::parse(response.body);
}

/// P(exactly n), over every choice of a hypothesis in every cluster and of who of it counts.
std::vector<double> counted(const World& world, const Description& description, int place) {
  const Belief& belief = *world.belief();
  std::vector<double> out(20, 0.0);
  const auto everyone = [&](auto& self, std::size_t c, std::size_t h, std::size_t a, int n,
                            double p) -> void {
    if (p == 0) return;
    if (c == belief.clusters.size()) {
      out[n] += p;
      return;
    }
    const Cluster& cluster = *belief.clusters[c];
    if (h == cluster.hypotheses.size()) {  // choose one
      for (std::size_t i = 0; i < h; ++i)
        self(self, c, i, 0, n, p * std::exp(cluster.hypotheses[i].log_weight));
      return;
    }
    if (a == cluster.anchors.size()) {
      const std::size_t next = c + 1;
      self(self, next, next < belief.clusters.size() ? belief.clusters[next]->hypotheses.size() : 0,
           0, n, p);
      return;
    }
    const int number = cluster.hypotheses[h].leaf[a];
    if (number == Hypothesis::kNoLeaf) return self(self, c, h, a + 1, n, p);
    Leaf leaf = *cluster.anchors[a].leaves[number];
    predict(leaf, belief.utime, *world.background());
    double counts = leaf.existence * match(leaf, description, *world.background());
    if (place >= 0) counts *= mass_in_place(leaf, place, *world.background());
    self(self, c, h, a + 1, n + 1, p * counts);
    self(self, c, h, a + 1, n, p * (1 - counts));
  };
  everyone(everyone, 0, belief.clusters[0]->hypotheses.size(), 0, 0, 1);
  return out;
}

TEST(Count, EqualsTheEnumerationOfWhoCounts) {
  const World world = ambiguous();
  std::size_t hypotheses = 0;
  for (const auto& cluster : world.belief()->clusters) hypotheses += cluster->hypotheses.size();
  ASSERT_GT(hypotheses, world.belief()->clusters.size()) << "the scene must be ambiguous";
  struct Question {
    std::string target;
    Description description;
    int place;
  };
  for (const Question& q : std::vector<Question>{
           {"/v1/count", {}, -1},
           {"/v1/count?class=cup", {{{0, 0}}}, -1},
           {"/v1/count?place=table", {}, 1},
           {"/v1/count?class=cup&color=red&place=kitchen", {{{0, 0}, {1, 0}}}, 0}}) {
    const Json answered = get(world, q.target);
    const auto expected = counted(world, q.description, q.place);
    const auto& distribution = answered["distribution"];
    ASSERT_LE(distribution.size(), expected.size());
    double sum = 0, mean = 0;
    for (std::size_t n = 0; n < expected.size(); ++n) {
      const double p = n < distribution.size() ? distribution[n].get<double>() : 0.0;
      EXPECT_NEAR(p, expected[n], kRounding) << q.target << ", " << n;
      sum += p;
      mean += static_cast<double>(n) * expected[n];
    }
    EXPECT_NEAR(sum, 1, kRounding);
    EXPECT_NEAR(answered["expected"].get<double>(), mean, kRounding);
    EXPECT_GT(answered["undetected"].get<double>(), 0);
    EXPECT_EQ(answered["utime"], at_second(1.5));
  }
}

TEST(Count, OfAnEmptyWorldIsZero) {
  const World world(small_world());
  const Json answered = get(world, "/v1/count?class=cup");
  EXPECT_EQ(answered["distribution"], Json::parse("[1.0]"));
  EXPECT_EQ(answered["expected"], 0);
  EXPECT_NEAR(answered["undetected"].get<double>(), 0.01 * 24, kRounding);
  EXPECT_NEAR(get(world, "/v1/count?place=table")["undetected"].get<double>(), 0.02, kRounding);
  EXPECT_NEAR(get(world, "/v1/count?color=red")["undetected"].get<double>(), 0.02 * 24 / 3,
              kRounding)
      << "a colour that nobody has seen is any of three";
  EXPECT_EQ(get(world, "/v1/count?size=small")["undetected"], 0);
}

TEST(Where, PlacesNestAndNullIsOutside) {
  const World world = ambiguous();
  const Json answered = get(world, "/v1/where?class=cup");
  ASSERT_GE(answered["answers"].size(), 2u);
  for (const Json& candidate : answered["answers"]) {
    std::map<std::string, double> mass;
    for (const Json& place : candidate["places"])
      mass[place["place"].is_null() ? "" : place["place"].get<std::string>()] = place["p"];
    // 0.001 is the least that is shown.
    EXPECT_NEAR(mass["kitchen"] + mass["hall"] + mass[""], 1, 2e-3 + 1e-6) << candidate;
    EXPECT_LE(mass["table"], mass["kitchen"] + kRounding);
    EXPECT_TRUE(candidate["places"].back()["place"].is_null());
    EXPECT_EQ(candidate["position"].size(), 2u);
    EXPECT_EQ(candidate["covariance"].size(), 4u);
  }
  for (std::size_t i = 1; i < answered["answers"].size(); ++i) {
    const Json &a = answered["answers"][i - 1], &b = answered["answers"][i];
    EXPECT_GE(a["p"].get<double>() * a["match"].get<double>(),
              b["p"].get<double>() * b["match"].get<double>());
  }
  for (const Json& place : answered["undetected"]) EXPECT_GT(place["expected"].get<double>(), 0);
}

TEST(Where, OutsideOfEveryPlace) {
  World world(small_world());
  apply(world, {frame(0, {at(-2, 1), at(3, 1, 1e-4)})});
  const Json lost = get(world, "/v1/where?object=cup-1")["answers"][0];
  ASSERT_EQ(lost["places"].size(), 1u);
  EXPECT_NEAR(lost["places"][0]["p"].get<double>(), 1, kRounding);
  const Json on_the_line = get(world, "/v1/where?object=cup-2")["answers"][0];
  EXPECT_NEAR(on_the_line["places"][0]["p"].get<double>(), 0.5, kRounding);
  EXPECT_NEAR(on_the_line["places"][1]["p"].get<double>(), 0.5, kRounding);
}

double match_of(const World& world, const std::string& description) {
  const Json answered = get(world, "/v1/where?object=cup-1&" + description);
  return answered["answers"][0]["match"];
}

TEST(Where, MatchIsTheProbabilityToFit) {
  World world(small_world());
  apply(world, {frame(0, {at(1, 1, "class", "cup", 0.8)})});
  EXPECT_NEAR(match_of(world, "class=cup"), 0.8, kRounding);
  EXPECT_NEAR(match_of(world, "color=red"), 1.0 / 3, kRounding) << "not held: uniform";
  EXPECT_NEAR(match_of(world, "class=cup&color=red"), 0.8 / 3, kRounding);
  EXPECT_EQ(match_of(world, "size=small"), 0) << "a scalar that is not held";
  Detection seen = at(1, 1, "color", "blue", 0.7);
  seen.attributes.push_back({"size", ScalarReport{0.15, 0.0001}});
  apply(world, {frame(1, {seen})});
  // Almost surely the same object: the weight of "another one" is what stays below 0.01.
  EXPECT_NEAR(match_of(world, "color=blue"), 0.7, 0.01);
  EXPECT_NEAR(match_of(world, "size=small"), 0.5, 0.01) << "0.15 m is the bound";
}

TEST(Objects, FiltersHoldFromOneHalf) {
  World world(small_world());
  apply(world, {frame(0, {at(1.5, 1.5, "class", "cup", 0.6), at(2.9, 3, "class", "cup", 0.4),
                          at(3.2, 1, "class", "box", 0.9)})});
  const auto listed = [&](const std::string& query) {
    std::vector<std::string> out;
    const Json answered = get(world, "/v1/objects" + query);
    for (const Json& object : answered["objects"]) out.push_back(object["id"]);
    std::sort(out.begin(), out.end());
    return out;
  };
  using Ids = std::vector<std::string>;
  EXPECT_EQ(listed(""), (Ids{"box-1", "box-2", "cup-1"}));
  EXPECT_EQ(listed("?class=cup"), Ids{"cup-1"});
  EXPECT_EQ(listed("?class=box&place=kitchen"), Ids{"box-1"});
  EXPECT_EQ(listed("?place=table"), Ids{"cup-1"});
  EXPECT_EQ(listed("?color=red"), Ids{}) << "a third each";
  EXPECT_EQ(listed("?min_p=0.9999"), Ids{});
  const Json all = get(world, "/v1/objects")["objects"];
  for (std::size_t i = 1; i < all.size(); ++i)
    EXPECT_GE(all[i - 1]["p"].get<double>(), all[i]["p"].get<double>());
  const Json table = get(world, "/v1/objects?place=table")["objects"][0];
  EXPECT_EQ(table["place"], "table") << "the deepest";
  EXPECT_EQ(table["last_seen"], at_second(0));
  EXPECT_NEAR(table["attributes"]["class"]["cup"].get<double>(), 0.6, kRounding);
}

TEST(Objects, OneObjectWithItsModelsAndAlternatives) {
  const World world = ambiguous();
  const Json cup = get(world, "/v1/objects/cup-1");
  EXPECT_EQ(cup["id"], "cup-1");
  EXPECT_EQ(cup["extent"], Json::parse("[0.1, 0.1, 0.12]"));
  double weights = 0, alternatives = 0;
  for (const Json& model : cup["models"]) weights += model["weight"].get<double>();
  for (const Json& one : cup["alternatives"]) alternatives += one["p"].get<double>();
  EXPECT_NEAR(weights, 1, kRounding);
  EXPECT_LE(alternatives, 1 + kRounding);
  EXPECT_GE(alternatives, 0.95) << "those below 0.001 are left out";
  EXPECT_GT(cup["alternatives"].size(), 1u);
}

TEST(Hypotheses, AreSortedAndSumToAtMostOne) {
  const World world = ambiguous();
  double before = 0;
  for (const int limit : {1, 3, 10, 1000}) {
    const Json answered = get(world, "/v1/hypotheses?limit=" + std::to_string(limit));
    const Json& worlds = answered["worlds"];
    ASSERT_GE(worlds.size(), 1u);
    if (limit == 1000) {
      ASSERT_GE(worlds.size(), 2u);
    }
    EXPECT_LE(worlds.size(), static_cast<std::size_t>(limit));
    double sum = 0, last = 1;
    for (const Json& w : worlds) {
      EXPECT_GT(w["p"].get<double>(), 0);
      // The first is the best world, even where several that look alike weigh more together.
      if (worlds.size() < 2 || &w != &worlds[1]) {
        EXPECT_LE(w["p"].get<double>(), last + kRounding);
      }
      sum += last = w["p"];
    }
    EXPECT_LE(sum, 1 + kRounding);
    EXPECT_GE(sum, before - kRounding);
    before = sum;
    EXPECT_TRUE(worlds[0]["differs"].empty());
    EXPECT_FALSE(worlds[0]["objects"].empty());
  }
  EXPECT_NEAR(before, 1, kRounding) << "1000 are all of them";
}

TEST(Answers, TheSameQuestionGivesTheSameBytes) {
  const World world = ambiguous(), again = ambiguous();
  for (const char* target : {"/v1/objects", "/v1/objects/cup-1", "/v1/where?class=cup",
                             "/v1/count?class=cup", "/v1/hypotheses?limit=5"}) {
    EXPECT_EQ(ask(world, target).body, ask(world, target).body);
    EXPECT_EQ(ask(world, target).body, ask(again, target).body);
    EXPECT_TRUE(ask(world, target).body.ends_with("\n"));
  }
}

TEST(Answers, RefusalsNameTheField) {
  const World world = ambiguous();
  const auto refused = [&](const std::string& target, int status, const std::string& field) {
    const HttpResponse response = ask(world, target);
    EXPECT_EQ(response.status, status) << target;
    const Json error = Json::parse(response.body)["error"];
    EXPECT_EQ(error.value("field", ""), field) << target;
    EXPECT_FALSE(error["message"].get<std::string>().empty());
    EXPECT_FALSE(error["code"].get<std::string>().empty());
  };
  refused("/v1/objects/cup-99", 404, "object");
  refused("/v1/where?object=cup-99", 404, "object");
  refused("/v1/nothing", 404, "");
  refused("/v1/where", 400, "object");
  for (const std::string path : {"/v1/objects", "/v1/where", "/v1/count"}) {
    refused(path + "?class=kup", 400, "class");
    refused(path + "?color=pink", 400, "color");
    refused(path + "?size=tiny", 400, "size");
    refused(path + "?place=garden", 400, "place");
    refused(path + "?colour=red", 400, "colour");
    refused(path + "?class=cup&class=box", 400, "class");
  }
  refused("/v1/objects?min_p=2", 400, "min_p");
  refused("/v1/objects?min_p=nan", 400, "min_p");
  refused("/v1/count?min_p=0.5", 400, "min_p");
  refused("/v1/hypotheses?limit=0", 400, "limit");
  refused("/v1/hypotheses?limit=ten", 400, "limit");
  refused("/v1/objects/cup-1?class=cup", 400, "class");
}

TEST(Answers, AnAliasIsAskedForLikeAnId) {
  World world = ambiguous();
  const std::string id = ids(world)[0];
  apply(world, named(1.5, id, "my mug"));
  EXPECT_EQ(get(world, "/v1/objects/my%20mug"), get(world, "/v1/objects/" + id));
  EXPECT_EQ(get(world, "/v1/objects/my%20mug")["alias"], "my mug");
  const Json where = get(world, "/v1/where?object=my%20mug");
  ASSERT_EQ(where["answers"].size(), 1u);
  EXPECT_EQ(where["answers"][0]["object"], id);
  EXPECT_EQ(ask(world, "/v1/objects/his%20mug").status, 404);
}

TEST(Answers, AnObjectThatIsMissingHasAModelForIt) {
  World world(small_world());
  apply(world, {frame(1, {at(1.5, 1.5)})});
  apply(world, missing(1, "cup-1", box_of_interest(1, 1, 2, 2)));
  const Json models = get(world, "/v1/objects/cup-1")["models"];
  ASSERT_EQ(models.size(), 2u);
  EXPECT_EQ(models[1]["kind"], "somewhere");
  EXPECT_NEAR(models[1]["weight"], 0.9, kRounding);  // p_D
  EXPECT_TRUE(models[1]["place"].is_null()) << "the world";
}

}  // namespace
}  // namespace anchord
