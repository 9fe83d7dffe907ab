#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "knowledge/configuration.h"
#include "tests/knowledge/one_mistake.h"

namespace anchord {
namespace {

const std::string kWorld = R"("world": {"bounds": {"min": [0, 0, 0], "max": [10, 8, 3]}})";
const std::string kPlaces = R"("places": [
  {"name": "kitchen", "polygon": [[0, 0], [4, 0], [4, 3], [0, 3]]},
  {"name": "table", "kind": "surface", "parent": "kitchen", "z": [0.6, 1.1],
   "polygon": [[1, 1], [2, 1], [2, 2], [1, 2]]}])";
const std::string kAttributes = R"("attributes": {
  "class": {"kind": "categorical", "symbols": ["cup", "box"]},
  "size": {"kind": "scalar"}})";

/// A configuration with the usual parts and `more` (such as `"classes": {...}`).
Configuration with(const std::string& more) {
  return parse_configuration("{" + kWorld + "," + kPlaces + "," + kAttributes +
                             (more.empty() ? "" : "," + more) + "}");
}

std::string all_text(const Configuration& configuration) {
  std::string text;
  for (const ConfigurationMistake& mistake : configuration.mistakes()) {
    text += mistake.text() + "\n";
  }
  return text;
}

using Case = OneMistake;

class MistakenKey : public testing::TestWithParam<Case> {};

TEST_P(MistakenKey, IsNotedWithItsPath) { expect_noted(with(GetParam().more), GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    Top, MistakenKey,
    testing::Values(
        Case{R"("sensor": {})", "sensor", "did you mean \"sensors\"?"},
        Case{R"("hypotheses": {"max": -1})", "hypotheses.max", "a whole number from 0"},
        Case{R"("hypotheses": {"max": 1.5})", "hypotheses.max", "not 1.5"},
        Case{R"("hypotheses": {"min_weight": 1})", "hypotheses.min_weight", "[0, 1)"},
        Case{R"("hypotheses": {"gate_probability": 0})", "hypotheses.gate_probability", "(0, 1]"},
        Case{R"("hypotheses": {"gate_probabilty": 1})", "hypotheses.gate_probabilty",
             "did you mean \"gate_probability\"?"},
        Case{R"("hypotheses": {"scan_depth": "all"})", "hypotheses.scan_depth", "not \"all\""},
        Case{R"("hypotheses": {"min_existence": null})", "hypotheses.min_existence", "not null"},
        Case{R"("hypotheses": {"min_symbol": 0.2})", "hypotheses.min_symbol", "[0, 0.1]"},
        Case{R"("hypotheses": {"frame_budget": -1})", "hypotheses.frame_budget", "not -1"},
        Case{R"("hypotheses": [])", "hypotheses", "must be an object"},
        Case{R"("log": 3)", "log", "must be an object"},
        Case{R"("log": {"keep": -1})", "log.keep", "not -1"},
        Case{R"("log": {"max_bytes": 1.5})", "log.max_bytes", "a whole number of bytes"},
        Case{R"("log": {"max_bytes": -1})", "log.max_bytes", "not -1"},
        Case{R"("log": {"history_grain": 0})", "log.history_grain", "(0, "},
        Case{R"("log": {"max_byte": 1})", "log.max_byte", "did you mean \"max_bytes\"?"},
        Case{R"("include": "home.json")", "include", "from a file only"}));

INSTANTIATE_TEST_SUITE_P(
    Classes, MistakenKey,
    testing::Values(
        Case{R"("classes": {"cups": {}})", "classes.cups", "did you mean \"cup\"?"},
        Case{R"("classes": {"cup": 3})", "classes.cup", "must be an object"},
        Case{R"("classes": {"cup": {"detection_probabilty": 0.5}})",
             "classes.cup.detection_probabilty", "did you mean \"detection_probability\"?"},
        Case{R"("classes": {"cup": {"detection_probability": 1}})",
             "classes.cup.detection_probability", "[0, 1), not 1"},
        Case{R"("classes": {"default": {"arrival_rate": -1e-5}})", "classes.default.arrival_rate",
             "of at least 0"},
        Case{R"("classes": {"cup": {"departure_rate": "never"}})", "classes.cup.departure_rate",
             "not \"never\""},
        Case{R"("classes": {"cup": {"undetected_intensity": -1}})",
             "classes.cup.undetected_intensity", "of at least 0"},
        Case{R"("classes": {"cup": {"extent": [1, 2]}})", "classes.cup.extent", "3 numbers"},
        Case{R"("classes": {"cup": {"models": []}})", "classes.cup.models", "detectable"},
        Case{R"("classes": {"cup": {"models": [{"kind": "somewhere"}]}})", "classes.cup.models",
             "detectable"},
        Case{R"("classes": {"cup": {"models": [{"kind": "constant_position",
                                                "detectable": false}]}})",
             "classes.cup.models", "detectable"},
        Case{R"("classes": {"cup": {"models": [{"kind": "constant_speed"}]}})",
             "classes.cup.models[0].kind", "there are: \"constant_position\""},
        Case{R"("classes": {"cup": {"models": [{}]}})", "classes.cup.models[0].kind", "is missing"},
        Case{R"("classes": {"cup": {"models": [{"kind": "constant_position",
                                                "acceleration_psd": 1}]}})",
             "classes.cup.models[0].acceleration_psd", "no such key"},
        Case{R"("classes": {"cup": {"models": [{"kind": "constant_velocity",
                                                "acceleration_psd": -1}]}})",
             "classes.cup.models[0].acceleration_psd", "of at least 0"},
        Case{R"("classes": {"cup": {"models": [{"kind": "constant_position", "vertical": -1}]}})",
             "classes.cup.models[0].vertical", "of at least 0"},
        Case{R"("classes": {"cup": {"models": [{"kind": "constant_position"},
                                     {"kind": "somewhere", "place": "tabel"}]}})",
             "classes.cup.models[1].place",
             "no place is called \"tabel\"; did you mean \"table\"?"},
        Case{R"("classes": {"cup": {"models": [{"kind": "constant_position"},
                                     {"kind": "somewhere", "rate": -1}]}})",
             "classes.cup.models[1].rate", "[0, 1e+06]"},
        Case{R"("classes": {"cup": {"models": [{"kind": "constant_position"},
                                     {"kind": "somewhere", "position_psd": 1}]}})",
             "classes.cup.models[1].position_psd", "no such key"},
        Case{R"("classes": {"cup": {"models": [{"kind": "constant_position"},
                                     {"kind": "somewhere", "stir": -1}]}})",
             "classes.cup.models[1].stir", "0"},
        Case{R"("classes": {"cup": {"models": [{"kind": "constant_position"},
                                     {"kind": "somewhere", "found_in": 2}]}})",
             "classes.cup.models[1].found_in", "from 0 to 1"},
        Case{R"("classes": {"cup": {"models": [{"kind": "constant_position"},
                                     {"kind": "somewhere", "found_in": 1}]}})",
             "classes.cup.models[1].found_in", "tracked"},
        Case{R"("classes": {"cup": {"models": [{"kind": "constant_position",
                                                "initial_weight": 0}]}})",
             "classes.cup.models", "initial_weight"}));

const char* const kTwoModels =
    R"("models": [{"kind": "constant_position"}, {"kind": "somewhere"}])";

TEST(ConfigurationMistakes, TransitionsLeaveTrackedModelsForOthers) {
  for (const auto& [transitions, path] : std::vector<std::pair<std::string, std::string>>{
           {R"([{"from": 0, "to": 2, "rate": 1}])", "[0].to"},
           {R"([{"from": 1, "to": 0, "rate": 1}])", "[0].from"},
           {R"([{"from": 0, "to": 0, "rate": 1}])", "[0]"},
           {R"([{"to": 0, "rate": 1}])", "[0].from"}}) {
    const auto configuration = with(R"("classes": {"cup": {)" + std::string(kTwoModels) +
                                    R"(, "transitions": )" + transitions + "}}");
    ASSERT_EQ(configuration.mistakes().size(), 1u) << all_text(configuration);
    EXPECT_EQ(configuration.mistakes()[0].path, "classes.cup.transitions" + path);
  }
  EXPECT_TRUE(with(R"("classes": {"cup": {)" + std::string(kTwoModels) +
                   R"(, "transitions": [{"from": 0, "to": 1, "rate": 1}]}})")
                  .ok());
}

INSTANTIATE_TEST_SUITE_P(
    Changes, MistakenKey,
    testing::Values(Case{R"("classes": {"cup": {"changes": []}})", "classes.cup.changes",
                         "must be an object"},
                    Case{R"("classes": {"cup": {"changes": {"sise": {}}}})",
                         "classes.cup.changes.sise", "did you mean \"size\"?"},
                    Case{R"("classes": {"cup": {"changes": {"class": {"redraw": 1}}}})",
                         "classes.cup.changes.class", "keeps its class"},
                    Case{R"("classes": {"cup": {"changes": {"size": {"drift": -1}}}})",
                         "classes.cup.changes.size.drift", "of at least 0"},
                    Case{R"("classes": {"cup": {"changes": {"size": {"redraw": 1}}}})",
                         "classes.cup.changes.size.redraw", "no such key"}));

INSTANTIATE_TEST_SUITE_P(
    Arrivals, MistakenKey,
    testing::Values(Case{R"("classes": {"cup": {"arrivals": [{"rate": 1}]}})",
                         "classes.cup.arrivals[0]", "must have \"place\""},
                    Case{R"("classes": {"cup": {"arrivals": [{"place": "table"}]}})",
                         "classes.cup.arrivals[0].rate", "is missing"},
                    Case{R"("classes": {"cup": {"arrivals": [{"place": "table", "mean": [1, 1, 1],
                                                  "rate": 1}]}})",
                         "classes.cup.arrivals[0]", "either"},
                    Case{R"("classes": {"cup": {"arrivals": [{"place": "tables", "rate": 1}]}})",
                         "classes.cup.arrivals[0].place", "did you mean \"table\"?"},
                    Case{R"("classes": {"cup": {"arrivals": [{"mean": [1, 1], "rate": 1,
                              "covariance": [1, 0, 0, 0, 1, 0, 0, 0, 1]}]}})",
                         "classes.cup.arrivals[0].mean", "3 numbers, not of 2"},
                    Case{R"("classes": {"cup": {"arrivals": [{"mean": [1, 1, 1], "rate": 1,
                              "covariance": [1, 0, 0, 0, -1, 0, 0, 0, 1]}]}})",
                         "classes.cup.arrivals[0].covariance", "positive definite"},
                    Case{R"("classes": {"cup": {"arrivals": [{"mean": [1, 1, 1], "rate": 1,
                              "covariance": [1, 0.5, 0, 0, 1, 0, 0, 0, 1]}]}})",
                         "classes.cup.arrivals[0].covariance", "symmetric"},
                    Case{R"("classes": {"cup": {"arrivals": [{"place": "table", "rate": 1,
                              "moves": true}]}})",
                         "classes.cup.arrivals[0].moves", "needs \"mean\""},
                    Case{R"("classes": {"cup": {"arrivals": [{"place": "table", "rate": 1,
                              "at_start": 1}]}})",
                         "classes.cup.arrivals[0].at_start", "\"moves\": true only"},
                    Case{R"("classes": {"cup": {"models": [{"kind": "constant_position"}],
                              "arrivals": [{"mean": [1, 1, 1], "rate": 1, "moves": true,
                              "covariance": [1, 0, 0, 0, 1, 0, 0, 0, 1],
                              "velocity": [1, 0, 0]}]}})",
                         "classes.cup.arrivals[0].velocity", "constant_position"},
                    Case{R"("classes": {"cup": {"arrivals": [{"mean": [1, 1, 1], "rate": 1,
                              "moves": true, "covariance": [1, 0, 0, 0, 1, 0, 0, 0, 1],
                              "velocity_covariance": [1, 0, 0, 0, 0, 0, 0, 0, 1]}]}})",
                         "classes.cup.arrivals[0].velocity_covariance", "positive definite"}));

INSTANTIATE_TEST_SUITE_P(
    Sensors, MistakenKey,
    testing::Values(
        Case{R"("sensors": {"default": {"clutter_density": 0}})", "sensors.default.clutter_density",
             "above 0"},
        Case{R"("sensors": {"kinect": {"cluter_density": 1}})", "sensors.kinect.cluter_density",
             "did you mean \"clutter_density\"?"},
        Case{R"("sensors": {"my sensor": {"pose_floor": -1}})", "sensors[\"my sensor\"].pose_floor",
             "of at least 0"},
        Case{R"("sensors": {"": {}})", "sensors[\"\"]", "a name has 1 to 100 bytes"},
        Case{R"("sensors": {"a": {"identity_doubt": 0}})", "sensors.a.identity_doubt", "(0, 1]"},
        Case{R"("sensors": {"a": {"double_detection": 1.5}})", "sensors.a.double_detection",
             "not 1.5"},
        Case{R"("classes": {"cup": {"models": [{"kind": "constant_position", "position_psd": 1,
                                                "shared_detection": {"reach": 1}}]}})",
             "classes.cup.models", "shares no"},
        Case{R"("classes": {"cup": {"models": [{"kind": "constant_position", "position_psd": 1},
                                               {"kind": "constant_position", "position_psd": 1,
                                                "shared_detection": {}}]}})",
             "classes.cup.models[1].shared_detection.reach", "is missing"},
        Case{R"("classes": {"cup": {"models": [{"kind": "constant_position", "position_psd": 1},
                                               {"kind": "constant_position", "position_psd": 1,
                                                "shared_detection": {"reach": 1,
                                                                     "size": "class"}}]}})",
             "classes.cup.models[1].shared_detection.size", "scalar"},
        Case{R"("sensors": {"a": {"real_share": 1}})", "sensors.a.real_share", "not 1"},
        Case{R"("sensors": {"a": {"score_memory": {"share": 1}}})", "sensors.a.score_memory.share",
             "not 1"},
        Case{R"("sensors": {"a": {"score_memory": {"seconds": 0}}})",
             "sensors.a.score_memory.seconds", "not 0"},
        Case{R"("classes": {"default": {"phantom": true}, "cup": {"phantom": false},
                            "box": {"phantom": false}})",
             "classes.default.phantom", "by name"},
        Case{R"("classes": {"cup": {"phantom": true}, "box": {"phantom": true}})", "classes",
             "no phantom"},
        Case{R"("sensors": {"a": {"score_calibration": [0.1, 0]}})", "sensors.a.score_calibration",
             "b above 0"},
        Case{R"("sensors": {"a": {"detection_probability": 1}})", "sensors.a.detection_probability",
             "[0, 1)"},
        Case{R"("sensors": {"a": {"detection_probability": [1]}})",
             "sensors.a.detection_probability", "a number, or [p, c]"},
        Case{R"("sensors": {"a": {"detection_probability": {"cop": 0.5}}})",
             "sensors.a.detection_probability.cop", "did you mean \"cup\"?"},
        Case{R"("sensors": {"a": {"detection_probability": {"cup": -0.1}}})",
             "sensors.a.detection_probability.cup", "[0, 1)"},
        Case{R"("sensors": {"a": {"noise": [1, 0, 0, 1]}})", "sensors.a.noise",
             "9 numbers, not of 4"},
        Case{R"("sensors": {"a": {"noise": [1, 0, 0, 0, 0, 0, 0, 0, 1]}})", "sensors.a.noise",
             "positive definite"},
        Case{R"("sensors": {"a": {"noise": {"polar": [1, 1, 0]}}})", "sensors.a.noise.polar[2]",
             "above 0"},
        Case{R"("sensors": {"a": {"noise": {"position": [1, 1, 0]}}})", "sensors.a.noise.position",
             "\"covariance\""},
        Case{R"("sensors": {"a": {"view": {"type": "cone"}}})", "sensors.a.view.type",
             "no type of view is called \"cone\""},
        Case{R"("sensors": {"a": {"view": {}}})", "sensors.a.view.type", "is missing"},
        Case{R"("sensors": {"a": {"view": {"type": "world", "range": [0, 1]}}})",
             "sensors.a.view.range", "no such key"},
        Case{R"("sensors": {"a": {"view": {"type": "sector", "bearing": [-1, 1]}}})",
             "sensors.a.view.range", "is missing"},
        Case{R"("sensors": {"a": {"view": {"type": "frustum", "range": [0, 1], "hfov": 4,
                                           "vfov": 1}}})",
             "sensors.a.view.hfov", "not 4"},
        Case{R"("sensors": {"a": {"view": {"type": "polygon", "points": [[0, 0], [1, 1]]}}})",
             "sensors.a.view.points", "three points"},
        Case{R"("sensors": {"a": {"prior": {"colour": {"red": 1}}}})", "sensors.a.prior.colour",
             "no attribute is called \"colour\""},
        Case{R"("sensors": {"a": {"prior": {"size": {"small": 1}}}})", "sensors.a.prior.size",
             "scalar"},
        Case{R"("sensors": {"a": {"prior": {"class": {"cup": 0.8, "box": 0.3}}}})",
             "sensors.a.prior.class", "at most 1"},
        Case{R"("sensors": {"a": {"prior": {"class": {"cup": 0, "box": 0}}}})",
             "sensors.a.prior.class", "not to 0"},
        Case{R"("sensors": {"a": {"prior": {"class": {"cop": 0.1}}}})", "sensors.a.prior.class.cop",
             "did you mean \"cup\"?"},
        Case{R"("sensors": {"a": {"confusion": {"class": {"cup": {"box": 2}}}}})",
             "sensors.a.confusion.class.cup.box", "[0, 1]"},
        Case{R"("sensors": {"a": {"confusion": {"class": {"cop": {"box": 0.1}}}}})",
             "sensors.a.confusion.class.cop", "did you mean \"cup\"?"}));

/// Mistakes in the parts that with() has already: whole texts.
class OneMistakeInText : public testing::TestWithParam<Case> {};

TEST_P(OneMistakeInText, IsNotedWithItsPath) {
  const Configuration configuration = parse_configuration(GetParam().more);
  ASSERT_EQ(configuration.mistakes().size(), 1u) << all_text(configuration);
  EXPECT_EQ(configuration.mistakes()[0].path, GetParam().path);
  EXPECT_NE(configuration.mistakes()[0].message.find(GetParam().message), std::string::npos)
      << configuration.mistakes()[0].message;
}

#define WORLD R"("world": {"bounds": {"min": [0, 0, 0], "max": [10, 8, 3]}})"
#define SQUARE R"("polygon": [[0, 0], [1, 0], [1, 1], [0, 1]])"

INSTANTIATE_TEST_SUITE_P(Json, OneMistakeInText,
                         testing::Values(Case{"", "", "line 1"}, Case{"[]", "", "one object"},
                                         Case{"{\n\"world\": }", "", "line 2, column 10"},
                                         Case{"{" WORLD ", \"places\": [], \"places\": []}", "",
                                              "stands twice"},
                                         Case{"{\"world\": 1e999}", "", "overflow"},
                                         Case{"{\"world\": \"\xff\"}", "", "UTF-8"}));

INSTANTIATE_TEST_SUITE_P(
    World, OneMistakeInText,
    testing::Values(
        Case{"{}", "world", "is missing"}, Case{R"({"world": {}})", "world.bounds", "is missing"},
        Case{R"({"world": {"bounds": {"min": [0, 0, 0]}}})", "world.bounds.max", "is missing"},
        Case{R"({"world": {"bounds": {"min": [0, 0], "max": [1, 1, 1]}}})", "world.bounds.min",
             "3 numbers, not of 2"},
        Case{R"({"world": {"dimensions": 4, "bounds": {"min": [0, 0, 0], "max": [1, 1, 1]}}})",
             "world.dimensions", "from 2 to 3"},
        Case{R"({"world": {"bounds": {"min": [0, 0, 0], "max": [1, 0, 1]}}})", "world.bounds",
             "below max"},
        Case{R"({"world": {"walls": [[[0, 0]]], "bounds": {"min": [0, 0, 0], "max": [1, 1, 1]}}})",
             "world.walls[0]", "two points"},
        Case{R"({"world": {"walls": [[[0, 0], [0, 0]]],
                           "bounds": {"min": [0, 0, 0], "max": [1, 1, 1]}}})",
             "world.walls[0]", "different"},
        Case{R"({"world": {"walls": [[[0, 0], [0]]],
                           "bounds": {"min": [0, 0, 0], "max": [1, 1, 1]}}})",
             "world.walls[0][1]", "2 numbers"},
        Case{R"({"world": {"walls": [{"z": [0, 1]}],
                           "bounds": {"min": [0, 0, 0], "max": [1, 1, 1]}}})",
             "world.walls[0].line", "is missing"},
        Case{R"({"world": {"walls": [{"line": [[0, 0], [1, 0]], "z": [1, 0]}],
                           "bounds": {"min": [0, 0, 0], "max": [1, 1, 1]}}})",
             "world.walls[0].z", "least below most"},
        Case{R"({"world": {"walls": [{"line": [[0, 0], [1, 0]], "z": [0, 1]}], "dimensions": 2,
                           "bounds": {"min": [0, 0], "max": [1, 1]}}})",
             "world.walls[0].z", "no heights"},
        Case{R"({"world": {"cell": 0, "bounds": {"min": [0, 0, 0], "max": [1, 1, 1]}}})",
             "world.cell", "above 0"},
        Case{R"({"world": {"cell": 0.01, "bounds": {"min": [0, 0, 0], "max": [99, 99, 1]}}})",
             "world.cell", "raise it"},
        Case{R"({"world": {"max_lateness": -1, "bounds": {"min": [0, 0, 0], "max": [1, 1, 1]}}})",
             "world.max_lateness", "[0, 3600]"},
        Case{R"({"world": {"max_leap": 0, "bounds": {"min": [0, 0, 0], "max": [1, 1, 1]}}})",
             "world.max_leap", "[1, 1"},
        Case{R"({"world": {"frame": 3, "bounds": {"min": [0, 0, 0], "max": [1, 1, 1]}}})",
             "world.frame", "not 3"}));

INSTANTIATE_TEST_SUITE_P(
    Places, OneMistakeInText,
    testing::Values(
        Case{"{" WORLD R"(, "places": {}})", "places", "an array"},
        Case{"{" WORLD R"(, "places": [{)" SQUARE "}]}", "places[0].name", "is missing"},
        Case{"{" WORLD R"(, "places": [{"name": "", )" SQUARE "}]}", "places[0].name", "a name"},
        Case{"{" WORLD R"(, "places": [{"name": "a"}]})", "places[0].polygon", "is missing"},
        Case{"{" WORLD R"(, "places": [{"name": "a", "polygon": [[0, 0], [1, 1]]}]})",
             "places[0].polygon", "three points"},
        Case{"{" WORLD
             R"(, "places": [{"name": "a", "polygon": [[0, 0], [3, 3], [3, 0], [0, 1]]}]})",
             "places[0].polygon", "cross"},
        Case{"{" WORLD R"(, "places": [{"name": "a", "polygon": [[0, 0], [1, 1], [1]]}]})",
             "places[0].polygon[2]", "2 numbers"},
        Case{"{" WORLD R"(, "places": [{"name": "a", "z": [1, 1], )" SQUARE "}]}", "places[0].z",
             "least below most"},
        Case{"{" WORLD R"(, "places": [{"name": "a", )" SQUARE R"(}, {"name": "a", )" SQUARE "}]}",
             "places[1].name", "places[0]"},
        Case{"{" WORLD R"(, "places": [{"name": "a", "parent": "b", )" SQUARE "}]}",
             "places[0].parent", "no place is called \"b\""},
        Case{"{" WORLD R"(, "places": [{"name": "a", "parent": "a", )" SQUARE "}]}",
             "places[0].parent", "lie in itself"}));

INSTANTIATE_TEST_SUITE_P(
    Attributes, OneMistakeInText,
    testing::Values(
        Case{"{" WORLD R"(, "attributes": {"color": {}}})", "attributes.color.kind", "is missing"},
        Case{"{" WORLD R"(, "attributes": {"color": {"kind": "scalr"}}})", "attributes.color.kind",
             "did you mean \"scalar\"?"},
        Case{"{" WORLD R"(, "attributes": {"color": {"kind": "categorical"}}})",
             "attributes.color.symbols", "is missing"},
        Case{"{" WORLD R"(, "attributes": {"color": {"kind": "categorical", "symbols": []}}})",
             "attributes.color.symbols", "at least one"},
        Case{"{" WORLD R"(, "attributes": {"color": {"kind": "categorical", "symbols": [1]}}})",
             "attributes.color.symbols[0]", "a name"},
        Case{"{" WORLD
             R"(, "attributes": {"color": {"kind": "categorical", "symbols": ["a", "a"]}}})",
             "attributes.color.symbols[1]", "there already"},
        Case{"{" WORLD R"(, "attributes": {"class": {"kind": "scalar"}}})", "attributes.class.kind",
             "must be categorical"},
        Case{"{" WORLD
             R"(, "attributes": {"class": {"kind": "categorical", "symbols": ["default"]}}})",
             "attributes.class.symbols", "template"},
        Case{"{" WORLD R"(, "attributes": {"class": {"kind": "categorical", "symbols": ["new"]}}})",
             "attributes.class.symbols", "new-1"},
        Case{"{" WORLD R"(, "attributes": {"size": {"kind": "scalar", "symbols": ["a"]}}})",
             "attributes.size.symbols", "no such key"},
        Case{"{" WORLD R"(, "attributes": {"size": {"kind": "scalar", "predicates": {"s": [1]}}}})",
             "attributes.size.predicates.s", "[least, most]"},
        Case{"{" WORLD
             R"(, "attributes": {"size": {"kind": "scalar", "predicates": {"s": [2, 1]}}}})",
             "attributes.size.predicates.s", "least below most"},
        Case{"{" WORLD R"(, "attributes": {"size": {"kind": "scalar", "reference_density": 0}}})",
             "attributes.size.reference_density", "above 0"},
        Case{"{" WORLD R"(, "classes": {"cup": {}}})", "classes.cup", "only \"object\""}));

TEST(ConfigurationMistakes, PlacesThatLieInEachOtherAreAllNamed) {
  const auto configuration =
      parse_configuration("{" WORLD R"(, "places": [{"name": "a", "parent": "b", )" SQUARE
                          R"(}, {"name": "b", "parent": "a", )" SQUARE
                          R"(}, {"name": "c", "parent": "a", )" SQUARE "}]}");
  ASSERT_EQ(configuration.mistakes().size(), 2u) << all_text(configuration);
  EXPECT_EQ(configuration.mistakes()[0].path, "places[0].parent");
  EXPECT_EQ(configuration.mistakes()[1].path, "places[1].parent");
}

}  // namespace
}  // namespace anchord
