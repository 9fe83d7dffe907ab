#include "api/verification_json.h"

#include <string>

#include "api/event_json.h"
#include "api/frame_json.h"
#include "api/json_fields.h"
#include "api/json_text.h"
#include "core/percent_encoding.h"

namespace anchord {
namespace {

using Json = nlohmann::json;

class VerificationReader : public JsonFields {
 public:
  bool read_trigger(const Json& json, Trigger& out) {
    if (!check_object(json, Field())) return false;
    for (const auto& [key, value] : json.items())
      if (!member(key, value, out)) return false;
    if (out.object.empty() == out.description.empty())
      return refuse(top_.member("object"),
                    "name the object by its id, or describe it, and not both");
    return true;
  }

  bool read_result(const Json& json, VerificationResult& out) {
    if (!check_object(json, Field())) return false;
    const Json* outcome = need(json, Field(), "outcome");
    std::string word;
    if (!outcome || !read(*outcome, top_.member("outcome"), word)) return false;
    if (word == "found")
      out.outcome = VerificationResult::Outcome::kFound;
    else if (word == "missing")
      out.outcome = VerificationResult::Outcome::kMissing;
    else if (word == "occluded")
      out.outcome = VerificationResult::Outcome::kOccluded;
    else
      return refuse(top_.member("outcome"), "must be one of found, missing, occluded");
    const bool missing = out.outcome == VerificationResult::Outcome::kMissing;
    if (missing && !need(json, Field(), "utime")) return false;
    return optional(json, "utime", out.utime) && optional(json, "sensor", out.sensor) &&
           optional(json, "robot", out.robot);
  }

 private:
  const Field top_{};  // the document itself

  bool member(const std::string& key, const Json& value, Trigger& out) {
    const Field field = top_.member(key.c_str());
    if (key == "object") return read(value, field, out.object);
    if (key == "description") return read(value, field, out.description);
    if (key == "action") return read(value, field, out.action);
    if (key == "robot") return read(value, field, out.robot);
    if (key == "sensor") return read(value, field, out.sensor);
    if (key == "timeout") return read(value, field, out.timeout_s);
    if (key == "tag") return read(value, field, out.tag);
    if (key == "alone") {
      if (!value.is_boolean()) return refuse(field, "must be true or false");
      out.alone = value.get<bool>();
      return true;
    }
    std::string symbol;  // an attribute of the description
    if (!read(value, field, symbol)) return false;
    out.description +=
        (out.description.empty() ? "" : "&") + percent_encoded(key) + "=" + percent_encoded(symbol);
    return true;
  }

  template <typename Value>
  bool optional(const Json& json, const char* key, Value& out) {
    const Json* value = find(json, key);
    return !value || read(*value, top_.member(key), out);
  }
};

Json attribute_json(const AttributeReport& report) {
  if (const auto* scalar = std::get_if<ScalarReport>(&report.value))
    return {{"mean", scalar->mean}, {"variance", scalar->variance}};
  Json symbols = Json::object();
  for (const auto& [symbol, p] : std::get<SymbolReport>(report.value).probabilities)
    symbols[symbol] = p;
  return symbols;
}

}  // namespace

Result<Trigger> parse_trigger(std::string_view text) {
  const auto json = parse_json(text);
  if (!json) return json.error();
  VerificationReader reader;
  Trigger trigger;
  if (!reader.read_trigger(*json, trigger)) return reader.error();
  return trigger;
}

Result<VerificationResult> parse_result(std::string_view text, std::int64_t task) {
  const auto json = parse_json(text);
  if (!json) return json.error();
  VerificationReader reader;
  VerificationResult result;
  result.task = task;
  if (!reader.read_result(*json, result)) return reader.error();
  if (const auto found = json->find("frame"); found != json->end()) {
    auto frame = frame_from_json(*found);
    if (!frame) {
      Error why = frame.error();
      why.field = why.field.empty() ? "frame" : "frame." + why.field;
      return why;
    }
    result.utime = frame->utime;
    result.frame = std::move(*frame);
  }
  return result;
}

const char* to_string(Task::State state) {
  switch (state) {
    case Task::State::kQueued:
      return "queued";
    case Task::State::kIssued:
      return "issued";
    case Task::State::kFound:
      return "found";
    case Task::State::kMissing:
      return "missing";
    case Task::State::kOccluded:
      return "occluded";
    case Task::State::kExpired:
      return "expired";
    case Task::State::kCancelled:
      return "cancelled";
  }
  return "";
}

Json to_json(const Task& task) {
  Json out{{"id", task.id},
           {"state", to_string(task.state)},
           {"object", task.object},
           {"class", task.object_class},
           {"triggered", task.triggered},
           {"reason", task.reason},
           {"created", task.created},
           {"deadline", task.deadline}};
  const auto text = [&](const char* key, const std::string& value) {
    if (!value.empty()) out[key] = value;
  };
  text("action", task.action);
  text("robot", task.robot);
  text("sensor", task.sensor);
  if (task.issued != 0) out["issued"] = task.issued;
  if (task.ended != 0) out["ended"] = task.ended;
  if (!task.tags.empty()) out["tags"] = task.tags;
  if (task.viewpoint)
    out["viewpoint"] = {{"position", task.viewpoint->position},
                        {"orientation", task.viewpoint->orientation}};
  for (const RegionOfInterest& region : task.regions) out["regions"].push_back(to_json(region));
  for (const AttributeReport& report : task.appearance)
    out["appearance"][report.name] = attribute_json(report);
  if (task.extent != std::array<double, 3>{}) out["extent"] = task.extent;
  if (task.viewpoint) {  // else nobody knows where the robot is
    out["gain"] = task.gain_nat;
    out["cost"] = task.cost;
    out["utility"] = task.utility;
  }
  return out;
}

}  // namespace anchord
