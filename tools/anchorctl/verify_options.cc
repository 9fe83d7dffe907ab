#include "tools/anchorctl/verify_options.h"

#include "tools/anchorctl/fields.h"

namespace anchord {
namespace {

constexpr const char* kRoot = "/v1/verifications";
constexpr double kLongest_s = 1e6;  ///< that the daemon takes

/// The first option that was given and belongs to a trigger; nullptr if there is none.
const char* of_a_trigger(const VerifyOptions& options) {
  if (!options.action.empty()) return "--action";
  if (!options.sensor.empty()) return "--sensor";
  if (!options.robot.empty()) return "--robot";
  if (options.timeout_s) return "--timeout";
  if (options.alone) return "--alone";
  return options.wait ? "--wait" : nullptr;
}

Result<HttpCall> trigger(const VerifyOptions& options, const Parameters& words) {
  if (options.all) return invalid("--all", "is for the list: name no object with it");
  Json body = Json::object();
  if (const std::string* object = find_parameter(words, "object")) {
    if (words.size() > 1) return invalid("object", "is named by its id or described, and not both");
    body["object"] = *object;
  } else {
    body["description"] = make_query(words);
  }
  const auto add = [&](const char* key, const std::string& value) {
    if (!value.empty()) body[key] = value;
  };
  add("action", options.action);
  add("sensor", options.sensor);
  add("robot", options.robot);
  if (options.timeout_s) body["timeout"] = *options.timeout_s;
  if (options.alone) body["alone"] = true;
  return HttpCall{"POST", kRoot, body.dump(-1, ' ', false, Json::error_handler_t::replace)};
}

}  // namespace

void add_options(CLI::App& command, VerifyOptions& options) {
  command.add_option("--action", options.action, "what will be done to it, such as grab");
  command.add_option("--sensor", options.sensor, "the sensor that shall look; default: the best");
  command.add_option("--robot", options.robot, "whose sensors shall look; default: any");
  command.add_option("--timeout", options.timeout_s, "seconds after which the task ends")
      ->check(CLI::Range(0.0, kLongest_s));
  command.add_flag("--alone", options.alone, "join no task that waits for the object already");
  command.add_flag("--wait", options.wait,
                   "until the task has ended; status 0 if the object was found, else 1");
  command.add_flag("--all", options.all, "list the tasks that have ended, too");
  command.add_option("--cancel", options.cancel, "ends the task of that number")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 53));
}

Result<HttpCall> verify_call(const VerifyOptions& options, const Parameters& words) {
  const char* extra = of_a_trigger(options);
  if (options.cancel) {
    if (!words.empty()) return invalid(words.front().first, "--cancel takes a number only");
    if (extra || options.all) return invalid(extra ? extra : "--all", "does not go with --cancel");
    return HttpCall{"DELETE", kRoot + ("/" + std::to_string(*options.cancel)), ""};
  }
  if (!words.empty()) return trigger(options, words);
  if (extra) return invalid(extra, "needs the object to look at: anchorctl verify OBJECT");
  return HttpCall{"GET", kRoot, ""};
}

}  // namespace anchord
